"""Every odd or broken mesh has its outcome and its code; rows that contradict the design are listed."""

import csv
import posixpath
import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from tests.conftest import SHARED
from tests.mesh_files import area
from worker.errors import MeshError
from worker.geometry.repair import repair
from worker.reading.mesh import Mesh
from worker.reading.upload import Upload, inspect_upload, read_mesh

ODD = SHARED / "odd-meshes"
FLAT = "flat and small surfaces are no fault: polygons are accepted, and REAL.tsv accepts single triangles"
NO_MTL = "a face uses a material whose MTL was not sent: missing_texture, whatever the number of faces"

# Rows that the design (section 4) contradicts: what comes instead, and why.
JUDGED_WRONG = {
    "ply_ngon1000_ascii.ply": ("none", FLAT),
    "geo_ngon1000.obj": ("none", FLAT),
    "geo_2_triangles.obj": ("none", FLAT),
    "box_UTF16BE.obj": ("not_utf8", "MADE.tsv refuses UTF-16, for which there is a code of its own"),
    "number_formats.obj": ("bad_number", "“3.1+e2” is no number; that the face has no area comes later"),
    "spider.obj": ("texture", "its images were sent: “.\\” and backslashes are no reason to miss them"),
    "cube_mtllib_after_g.obj": ("missing_texture", NO_MTL),
    "cube_mtllib_missing.obj": ("missing_texture", NO_MTL),
    "jacked.obj": ("missing_texture", NO_MTL),
    "notenoughindices.obj": ("missing_texture", NO_MTL),
    "polygonfaces.obj": ("missing_texture", NO_MTL),
    "singlevn.obj": ("missing_texture", NO_MTL),
    "issue-244-mtl-searchpaths.obj": ("missing_texture", NO_MTL),
}
# Codes of the tables that are broader than those of the program.
BROADER = {
    "malformed": {"truncated", "bad_header", "bad_data"},
    "not_a_mesh": {"not_ply", "not_obj"},
}
COLOURS = {  # what a row says of the colour, where it does
    "ok:vertex_colors": "vertex",
    "ok:vertex_colors(constant)": "vertex",
    "ok:vertex": "vertex",
    "ok:face": "face",
    "ok:texture": "texture",
    "ok:material_colour": "material",
    "ok:material-only": "material",
    "ok:no_colour": "none",
    "ok:none": "none",
}


def rows(table: str) -> list[dict[str, str]]:
    path = ODD / table
    if not path.is_file():
        return []
    with path.open(encoding="utf-8") as lines:
        return list(csv.DictReader(lines, delimiter="\t", quoting=csv.QUOTE_NONE))


def made(entry: str) -> dict[str, bytes]:
    """Return a file alone, or all files of the folder that a mesh has for itself."""
    path = ODD / "made" / entry
    if "/" not in entry:
        return {path.name: path.read_bytes()}
    return {file.name: file.read_bytes() for file in path.parent.iterdir()}


def real(entry: str) -> dict[str, bytes]:
    """Return a mesh with what it names inside its repository's folder."""
    root = ODD / "real" / entry.split("/")[0]
    names, left = set[str](), [entry.split("/", 1)[1]]
    while left:
        name = left.pop()
        if name not in names and (root / name).is_file():
            names.add(name)
            if not name.lower().endswith((".png", ".jpg")):
                left += [
                    posixpath.normpath(posixpath.join(posixpath.dirname(name), other))
                    for other in named(root / name)
                ]
    return {name: (root / name).read_bytes() for name in names}


def named(path: Path) -> Iterator[str]:
    """Yield what may be file names in a mesh or a material file."""
    for line in path.read_bytes().decode("latin-1").splitlines():
        match = re.match(r"\s*(?:mtllib|map_Kd|comment\s+TextureFile)\s+(.*\S)", line)
        if match:
            whole = match[1].replace("\\ ", " ").replace("\\", "/")
            yield from (whole, *whole.split(), *re.split(r"(?<=\.mtl)\s+", whole))


def outcome(files: dict[str, bytes]) -> tuple[str, Mesh | str]:
    try:
        mesh = read_mesh(Upload(files=files))
        repair(mesh)
    except MeshError as caught:
        return "refuse", str(caught.code)
    return "accept", mesh


def check(files: dict[str, bytes], name: str, expected: str, code: str) -> None:
    if name in JUDGED_WRONG:
        code, _ = JUDGED_WRONG[name]
        expected = "accept" if code in COLOURS.values() else "refuse"
    found, result = outcome(files)
    if isinstance(result, Mesh):
        assert (found, COLOURS.get(code, str(result.colour))) == (expected, str(result.colour))
        inspect_upload(Upload(files=files))
    else:
        assert found == expected, result
        assert result in BROADER.get(code, {code})


@pytest.mark.parametrize("row", rows("MADE.tsv"), ids=lambda row: str(row["entry"]))
def test_made_meshes_have_their_outcome(odd_meshes_folder: Path, row: dict[str, str]) -> None:
    assert odd_meshes_folder == ODD
    check(made(row["entry"]), row["entry"], row["expected"], row["code"])


@pytest.mark.parametrize("row", rows("REAL.tsv"), ids=lambda row: str(row["path"]))
def test_real_meshes_have_their_outcome(odd_meshes_folder: Path, row: dict[str, str]) -> None:
    assert odd_meshes_folder == ODD
    check(real(row["path"]), Path(row["path"]).name, row["expected"], row["code"])


def test_every_row_judged_wrong_is_a_row(odd_meshes_folder: Path) -> None:
    assert odd_meshes_folder == ODD
    entries = {row["entry"] for row in rows("MADE.tsv")} | {
        Path(row["path"]).name for row in rows("REAL.tsv")
    }
    assert JUDGED_WRONG.keys() <= entries


@pytest.mark.parametrize(
    ("entry", "faces", "components"),
    [
        ("ply_mixed_tri_quad_bin.ply", 300, None),
        ("obj_neg_relative_interleaved.obj", 12, 3),
        ("ply_ok_ascii.ply", 720, 1),
    ],
)
def test_good_meshes_that_others_misread_are_whole(
    odd_meshes_folder: Path, entry: str, faces: int, components: int | None
) -> None:
    assert odd_meshes_folder == ODD
    mesh = read_mesh(Upload(files=made(entry)))
    assert len(mesh.faces) == faces
    assert components in {None, repair(mesh).components}


def test_relative_indices_give_the_area_of_the_room(odd_meshes_folder: Path) -> None:
    assert odd_meshes_folder == ODD
    mesh = read_mesh(Upload(files=real("tinyobjloader+tinyobjloader/models/cornell_box.obj")))
    assert area(mesh.vertices, mesh.faces) == pytest.approx(1.9896e6, rel=1e-4)


def test_colours_of_every_number_type_agree(odd_meshes_folder: Path) -> None:
    assert odd_meshes_folder == ODD
    found = [
        read_mesh(Upload(files=made(f"ply_col_{kind}.ply"))).corner_colours
        for kind in ("float01", "ushort", "diffuse_names")
    ]
    assert np.ptp(found, axis=0).max() <= 1 / 255
