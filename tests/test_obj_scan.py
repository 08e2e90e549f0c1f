"""A quick look at an OBJ file sees the names that a full reading sees."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.mesh_files import read
from worker.errors import MeshError
from worker.reading.obj_scan import named_libraries, used_materials

LINES = [
    "usemtl a",
    "\tusemtl b c ",
    "usemtl",
    "f 1 2 3",
    " f 1/1 2/1 3/1",
    "f 1/1 2/1 3/",
    "f 1/1 2/1",
    "usemtl\vd",
    "#usemtl x",
    "o usemtl",
    "vt 0 0",
    "g",
]


def test_libraries_are_found_and_comments_are_not() -> None:
    assert named_libraries(b"mtllib a b.mtl\n# mtllib x\n \tmtllib\tc.mtl") == ["a b.mtl", "c.mtl"]


@pytest.mark.parametrize(
    ("text", "used"),
    [
        (b"usemtl a\nv 0 0 0\n", {}),
        (b"usemtl a\nf 1 2 3\n", {"a": False}),
        (b"vt 0 0\nusemtl a\nf 1 2 3\n", {"a": False}),
        (b"\nvt 0 0\nusemtl a\nf 1//1 2//1 3//1\nf 1/1 2/1 3/1\n", {"a": True}),
        (b"\nvt 0 0\nf 1/1 2/1 3/1\nusemtl a\nusemtl b\nf 1 2 3\nusemtl b\nf 1/1 2/1 3/1\n", {"b": True}),
        (b"\nvt 0 0\nusemtl a\nf 1/1 2/1 3/\n", {"a": False}),  # one corner has none: the face has none
        (b"\nvt 0 0\nusemtl a\nf 1/1 2/1\n", {}),  # reading drops the face
        (b"\nvtx 0 0\nusemtl a\nf 1/1 2/1 3/1\n", {"a": False}),  # no texture coordinates
        (b"\nvt 0 0\nusemtl\va\nf +1/-1/ 2/1/1 3/1 # 4\n", {"a": True}),
        (b"", {}),
    ],
)
def test_materials_count_where_a_face_follows(text: bytes, used: dict[str, bool]) -> None:
    assert used_materials(text) == used


@given(st.lists(st.sampled_from(LINES), max_size=12))
def test_it_misses_no_material_of_a_face(lines: list[str]) -> None:
    text = "\nv 0 0 0\nv 1 0 0\nv 0 1 0\n" + "\n".join(lines)
    try:
        mesh = read({"m.obj": text})
    except MeshError:
        return
    used = used_materials(text.encode())
    undefined = [warning for warning in mesh.warnings if "materials are not defined" in warning]
    assert len(used.keys() - {""}) == (int(undefined[0].split()[0]) if undefined else 0)
