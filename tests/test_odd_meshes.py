"""Every odd or broken mesh has its outcome and its code; rows that contradict the design are listed."""

from pathlib import Path

import numpy as np
import pytest

from tests.mesh_files import area
from tests.odd_meshes import JUDGED_WRONG, ODD, OddMesh, made, odd_meshes, real
from worker.errors import MeshError
from worker.geometry.repair import repair
from worker.reading.mesh import Mesh
from worker.reading.upload import Upload, inspect_upload, read_mesh


def outcome(files: dict[str, bytes]) -> Mesh | str:
    try:
        mesh = read_mesh(Upload(files=files))
        repair(mesh)
    except MeshError as caught:
        return str(caught.code)
    return mesh


def check(row: OddMesh) -> None:
    result = outcome(row.files)
    if isinstance(result, Mesh):
        assert row.accepted
        assert row.colour in {None, str(result.colour)}
        inspect_upload(Upload(files=row.files))
    else:
        assert result in row.codes


@pytest.mark.parametrize("row", odd_meshes("MADE.tsv"), ids=lambda row: str(row.entry))
def test_made_meshes_have_their_outcome(odd_meshes_folder: Path, row: OddMesh) -> None:
    assert odd_meshes_folder == ODD
    check(row)


@pytest.mark.parametrize("row", odd_meshes("REAL.tsv"), ids=lambda row: str(row.entry))
def test_real_meshes_have_their_outcome(odd_meshes_folder: Path, row: OddMesh) -> None:
    assert odd_meshes_folder == ODD
    check(row)


def test_every_row_judged_wrong_is_a_row(odd_meshes_folder: Path) -> None:
    assert odd_meshes_folder == ODD
    assert JUDGED_WRONG.keys() <= {row.name for row in odd_meshes("MADE.tsv", "REAL.tsv")}


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
