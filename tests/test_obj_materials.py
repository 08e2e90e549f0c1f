"""Which material files an OBJ file means, and when one is missed."""

import pytest

from tests.mesh_files import TRIANGLE, read, refusal
from worker.errors import Code
from worker.reading.mesh import Colour
from worker.reading.obj_materials import library_names
from worker.reading.references import SentFiles

USED = f"{TRIANGLE}usemtl a\nf 1 2 3\n"
MTL = "newmtl a\nKd 1 0 0\n"


@pytest.mark.parametrize(
    ("rest", "names"),
    [
        ("m.mtl", ["m.mtl"]),
        ("my file.mtl", ["my file.mtl"]),
        ("my\\ file.mtl", ["my file.mtl"]),
        ('"my file.mtl"', ["my file.mtl"]),
        ("a.mtl B.MTL  m.mtl", ["a.mtl", "B.MTL", "m.mtl"]),
        ("no blanks.mtl my\\ file.mtl", ["no blanks.mtl", "my file.mtl"]),
        ("", []),
    ],
)
def test_names_after_mtllib_are_one_with_blanks_or_several(rest: str, names: list[str]) -> None:
    assert library_names(rest, "m.obj", SentFiles({"my file.mtl": b"", "m.mtl": b""})) == names


def test_a_missing_file_is_refused_where_a_face_uses_its_material() -> None:
    assert refusal({"m.obj": f"mtllib m.mtl\n{USED}"}) == Code.MISSING_TEXTURE


def test_a_missing_file_is_no_loss_where_no_face_uses_a_material() -> None:
    mesh = read({"m.obj": f"mtllib m.mtl\n{TRIANGLE}f 1 2 3\nusemtl a\n"})
    assert "material files were not sent" in mesh.warnings[0]


def test_a_missing_file_is_no_loss_where_another_defines_the_material() -> None:
    mesh = read({"m.obj": f"mtllib gone.mtl m.mtl\n{USED}", "m.mtl": MTL})
    assert mesh.colour == Colour.MATERIAL


def test_a_missing_file_is_allowed_on_request_even_outside_of_the_upload() -> None:
    for name in ("m.mtl", "/home/artist/m.mtl", "../m.mtl"):
        mesh = read({"m.obj": f"mtllib {name}\n{USED}"}, allow_untextured=True)
        assert mesh.colour == Colour.NONE
        assert mesh.warnings


@pytest.mark.parametrize("name", ["/dev/zero", "../sibling.mtl", "../../../etc/passwd"])
def test_a_name_outside_of_the_upload_is_refused(name: str) -> None:
    assert refusal({"m.obj": f"mtllib {name}\n{USED}"}) == Code.UNSAFE_REFERENCE


def test_a_material_without_a_definition_is_named_in_a_warning() -> None:
    mesh = read({"m.obj": f"mtllib m.mtl\n{USED}usemtl other\nf 1 2 3\n", "m.mtl": MTL})
    assert "“other”" in mesh.warnings[0]


def test_the_first_of_two_definitions_counts() -> None:
    files = {"m.obj": f"mtllib m.mtl\nmtllib n.mtl\n{USED}", "m.mtl": MTL, "n.mtl": "newmtl a\nKd 0 0 1\n"}
    assert read(files).corner_colours[0, 0].tolist() == [1, 0, 0]
