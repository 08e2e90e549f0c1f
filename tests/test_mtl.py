"""Materials as programs write them."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.mesh_files import attempt
from worker.errors import Code, MeshError
from worker.reading.mtl import read_map, read_mtl


@pytest.mark.parametrize(
    ("rest", "file"),
    [
        ("t.png", "t.png"),
        ("my tex 01.png", "my tex 01.png"),
        ("two  blanks.png", "two  blanks.png"),
        ("-s 1 1 1 t.png", "t.png"),
        ("-o 0.1 t.png", "t.png"),
        ("-clamp on my tex.png", "my tex.png"),
        ("-blendu on -blendv off -mm 0 1 t.png", "t.png"),
        ("-colorspace sRGB -o 0.1 t.png", "t.png"),
        ("-texres 512 t.png", "t.png"),
        ("t.png -bm 1.5", "t.png"),
        ("tex-s-1.png", "tex-s-1.png"),
        ("..\\maps\\t.png", "..\\maps\\t.png"),
        ('"t u.png"', "t u.png"),
        ("-s 2 2 123.png", "123.png"),
    ],
)
def test_the_name_of_an_image_is_found_among_options(rest: str, file: str) -> None:
    texture = read_map(rest, "m.mtl")
    assert texture is not None
    assert texture.reference == file


def test_scale_and_offset_are_kept() -> None:
    texture = read_map("-s 2 3 -o 0.25 t.png", "m.mtl")
    assert texture is not None
    assert (texture.scale, texture.offset) == ((2.0, 3.0), (0.25, 0.0))


def test_materials_have_their_colour_and_image() -> None:
    text = b"# by hand\nnewmtl  red wood \r\n\tKd 1 0.5 0\n\tKd 1 0 0 # final\nNs 1\nnewmtl b\nmap_Kd t.png\n"
    found = read_mtl(text, "m.mtl")
    assert found["red wood"].colour == (1.0, 0.0, 0.0)
    assert found["red wood"].texture is None
    assert found["b"].texture is not None
    assert found["b"].texture.named_by == "m.mtl"


@pytest.mark.parametrize(
    ("rest", "colour"), [("0.5", (0.5, 0.5, 0.5)), ("2 -1 0", (1.0, 0.0, 0.0)), ("xyz 1", None)]
)
def test_a_colour_of_one_number_is_grey_and_others_are_cut_to_the_range(
    rest: str, colour: tuple[float, ...] | None
) -> None:
    assert read_mtl(f"newmtl a\nKd {rest}\n".encode(), "m.mtl")["a"].colour == colour


def test_a_material_without_a_name_is_left_out() -> None:
    assert read_mtl(b"newmtl \nKd 1 0 0\n", "m.mtl") == {}


def test_names_in_another_encoding_are_still_told_apart() -> None:
    assert set(read_mtl(b"newmtl Terraind\x84k\nKd 1 1 1\nnewmtl T\xc3\xa9\n", "m.mtl")) == {
        "Terraind\x84k",
        "T\u00c3\u00a9",
    }


def test_a_colour_that_is_no_number_is_refused() -> None:
    with pytest.raises(MeshError) as caught:
        read_mtl(b"newmtl a\nKd 0,5 0 0\n", "m.mtl")
    assert caught.value.code == Code.BAD_NUMBER


@given(st.binary(max_size=200))
def test_any_bytes_are_read_or_refused(data: bytes) -> None:
    assert attempt(lambda: read_mtl(b"newmtl a\nKd " + data, "m.mtl")) in {None, Code.BAD_NUMBER}
