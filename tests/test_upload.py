"""The one way in: files of any kind become a mesh, or a refusal with a code."""

import io
import zipfile
from pathlib import Path

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st

from tests.mesh_files import TEXTURED, attempt, ply_binary, ply_header, png, read, refusal
from worker.errors import Code, MeshError
from worker.geometry.repair import repair
from worker.reading.limits import Limits
from worker.reading.mesh import Colour, Mesh
from worker.reading.upload import Upload, inspect_upload, read_mesh

FILES = {"set/m.obj": TEXTURED.encode(), "set/m.mtl": b"newmtl a\nmap_Kd t.png\n", "set/t.png": png()}


def zipped(files: dict[str, bytes]) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for name, data in files.items():
            archive.writestr(name, data)
    return stream.getvalue()


def test_every_image_that_a_ply_names_must_be_there_and_whole_though_no_face_shows_it() -> None:
    header = ply_header("ascii", 3, 1).replace(
        b"element vertex", b"comment TextureFile t.png\nelement vertex"
    )
    header = header.replace(b"end_header", b"property list uchar float texcoord\nend_header")
    mesh = header + b"0 0 0\n1 0 0\n0 1 0\n3 0 1 2 0\n"
    for files, code in (
        ({"m.ply": mesh}, Code.MISSING_TEXTURE),
        ({"m.ply": mesh, "t.png": b"no image"}, Code.BAD_IMAGE),
    ):
        assert refusal(files) == code
        assert attempt(lambda files=files: inspect_upload(Upload(files=files))) == code  # type: ignore[misc]
    assert read({"m.ply": mesh}, allow_untextured=True).colour == Colour.NONE
    assert read({"m.ply": mesh, "t.png": png()}).textures == ()


def test_a_zip_reads_as_its_files_do() -> None:
    loose, packed = read(FILES), read({"any.ZIP": zipped(FILES)})
    assert loose.colour == packed.colour == Colour.TEXTURE
    np.testing.assert_array_equal(loose.corner_uvs, packed.corner_uvs)
    np.testing.assert_array_equal(loose.textures[0], packed.textures[0])


@pytest.mark.parametrize(
    ("files", "code"),
    [
        ({}, Code.NO_MESH),
        ({"t.png": png()}, Code.NO_MESH),
        ({"a.zip": zipped({"readme.txt": b""})}, Code.NO_MESH),
        ({"a.zip": zipped({**FILES, "n.ply": b""})}, Code.SEVERAL_MESHES),
        ({"a.zip": b"PK"}, Code.BAD_ARCHIVE),
        ({"a.zip": zipped(FILES), "n.ply": b""}, Code.BAD_ARCHIVE),
        ({"m.ply": ply_binary(np.eye(3), [[0, 1, 2]] * 3)[:-1]}, Code.TRUNCATED),
        ({"m.OBJ": b""}, Code.EMPTY),
    ],
)
def test_an_upload_without_one_whole_mesh_is_refused(files: dict[str, bytes], code: Code) -> None:
    assert refusal(files) == code


def test_inspection_opens_small_zips_and_lists_large_ones(monkeypatch: pytest.MonkeyPatch) -> None:
    bad = {**FILES, "set/t.png": b"no image"}
    with pytest.raises(MeshError) as caught:
        inspect_upload(Upload(files={"a.zip": zipped(bad)}))
    assert caught.value.code == Code.BAD_IMAGE
    monkeypatch.setattr("worker.reading.upload._SMALL", 10)
    inspect_upload(Upload(files={"a.zip": zipped(bad)}))
    with pytest.raises(MeshError, match="found 2"):
        inspect_upload(Upload(files={"a.zip": zipped({**bad, "n.ply": b""})}))


@given(st.sampled_from(sorted(FILES)), st.binary(max_size=8), st.integers(0, 100), st.booleans())
def test_a_damaged_file_is_read_or_refused_and_inspection_refuses_no_more(
    name: str, junk: bytes, place: int, allowed: bool
) -> None:
    files = {**FILES, name: FILES[name][:place] + junk + FILES[name][place + len(junk) :]}
    upload = Upload(files=files, allow_untextured=allowed)
    limits = Limits(image_pixels=1_000)
    if attempt(lambda: read_mesh(upload, limits)) is None:
        inspect_upload(upload, limits)


def meshes_of(folder: Path) -> list[tuple[Path, Mesh]]:
    """Read every mesh of a folder with the files beside it."""
    found = []
    for path in sorted(folder.rglob("*")):
        if path.suffix == ".ply":
            found.append((path, read({path.name: path.read_bytes()})))
        elif path.suffix == ".obj":
            root = path.parent.parent if path.parent.name == "meshes" else path.parent
            beside = [file for file in root.rglob("*") if file.suffix in {".mtl", ".png"}]
            found.append(
                (path, read({str(file.relative_to(root)): file.read_bytes() for file in [path, *beside]}))
            )
    return found


def counted_by_trimesh(path: Path) -> int:
    loaded = trimesh.load(path, process=False, force="mesh", skip_materials=True)
    assert isinstance(loaded, trimesh.Trimesh)
    return len(loaded.faces)


@pytest.mark.parametrize(
    "part", ["clutter", "textured", "posed/q_animals__Cow", "posed/mh_11_female_cauc_suitskin"]
)
def test_real_meshes_are_read_whole_and_in_colour(data_folder: Path, part: str) -> None:
    found = meshes_of(data_folder / part)
    assert found
    for path, mesh in found:
        assert len(mesh.faces) == counted_by_trimesh(path), path
        assert mesh.colour == (Colour.VERTEX if path.suffix == ".ply" else Colour.TEXTURE), path
        assert len(repair(mesh).faces) > 0.97 * len(mesh.faces), path
