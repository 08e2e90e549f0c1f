"""OBJ files, from bytes to colours."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.mesh_files import TEXTURED, TRIANGLE, area, attempt, png, read, refusal
from worker.errors import Code
from worker.reading.mesh import Colour

FACE = "f 1 2 3\n"
LINES = [
    *("v 0 0 0", "v 1 0 1", "v nan 0 0", "v 1 2", "vt 0 1", "f 1 2 3", "f 1/1 2/1 -1/-1", "f -3 -2 -1 1"),
    *("f 9 9 9", "f 1/2/3/4", "f", "usemtl a", "mtllib b.mtl", "o x", "\\", "#"),
]
SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"


@pytest.mark.parametrize(
    "text",
    [
        f"{SQUARE}f 1 2 3 4\n",
        f"{SQUARE}f -4 -3 -2 -1\n",
        f"f 1 2 3 4\n{SQUARE}",
        f"{SQUARE}f 1 2 3 4",
        f"{SQUARE}f 1 2 \\\n3 \\\n4\n",
        f"\ufeff{SQUARE}f\t1\t2\t3\t4\n",
        f"{SQUARE}g a f b\nf 1// 2// 3// 4//\ng\n",
        f"call ../x\ncsh -touch x\n{SQUARE}vn 0 0 1\ns off\no x\nl 1 2\np 1\nf 1//1 2//1 3//1 4//1\n",
    ],
)
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_every_way_to_write_a_square_reads_the_same(text: str, end: str) -> None:
    mesh = read({"m.obj": text.replace("\n", end)})
    assert area(mesh.vertices, mesh.faces) == 1.0
    assert len(mesh.faces) == 2


@given(st.integers(1, 6), st.integers(1, 40))
def test_relative_indices_count_from_their_own_line(n_parts: int, step: int) -> None:
    part = "v {0} 0 0\nv {0}.5 0 0\nv {0} 1 0\nf -3 -2 -1\n"
    mesh = read({"m.obj": "".join(part.format(place * step) for place in range(n_parts))})
    assert mesh.faces.tolist() == [[3 * place, 3 * place + 1, 3 * place + 2] for place in range(n_parts)]


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("", Code.EMPTY),
        (" \n\t\n", Code.EMPTY),
        ("# nothing\n", Code.EMPTY),
        ("mtllib a.mtl\nusemtl a\n", Code.EMPTY),
        (FACE, Code.EMPTY),
        (SQUARE, Code.NO_FACES),
        (f"{SQUARE}l 1 2\np 1\n", Code.NO_FACES),
        ("g An f Three Other Things\nv 1 2 3\n", Code.NO_FACES),
        (f"{SQUARE}f 1 2\nf\n", Code.BAD_DATA),
        (f"{SQUARE}f 1 2 5\n", Code.INDEX_OUT_OF_RANGE),
        (f"{SQUARE}f 0 1 2\n", Code.INDEX_OUT_OF_RANGE),
        (f"{SQUARE}f -5 1 2\n", Code.INDEX_OUT_OF_RANGE),
        (f"{SQUARE}vt 0 0\nf 1/1 2/2 3/1\n", Code.INDEX_OUT_OF_RANGE),
        (f"{SQUARE}vt 0 0\nf 1/0 2/1 3/1\n", Code.INDEX_OUT_OF_RANGE),
        (f"{SQUARE}v 0,5 1 2\n{FACE}", Code.BAD_NUMBER),
        (f"v nan 0 0\n{SQUARE}{FACE}", Code.NON_FINITE),
        (f"v 1e999 0 0\n{SQUARE}{FACE}", Code.NON_FINITE),
        (f"v 1.#IND 0 0\n{SQUARE}{FACE}", Code.NON_FINITE),
        (f"{SQUARE}vt nan 0\nf 1/1 2/1 3/1\n", Code.NON_FINITE),
        (f"{SQUARE}\0{FACE}", Code.BAD_DATA),
        ("version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n", Code.NOT_OBJ),
        ("ply\nformat binary_little_endian 1.0\n\0\0", Code.NOT_OBJ),
        ("ply\nformat ascii 1.0\nend_header\n", Code.NOT_OBJ),
    ],
)
def test_what_is_no_mesh_is_refused(text: str, code: Code) -> None:
    assert refusal({"m.obj": text}) == code


@pytest.mark.parametrize("encoding", ["utf-16-le", "utf-16-be"])
def test_another_encoding_is_named(encoding: str) -> None:
    data = f"\ufeff{SQUARE}{FACE}".encode(encoding)
    assert refusal({"m.obj": data}) == Code.NOT_UTF8


def test_old_encodings_of_names_and_comments_do_no_harm() -> None:
    data = f"# Maßstab\n{SQUARE}usemtl Tür\n{FACE}".encode("latin-1")
    assert len(read({"m.obj": data}).faces) == 1


def test_a_triangle_keeps_its_texture_its_coordinates_and_its_order() -> None:
    mesh = read({"m.obj": TEXTURED, "m.mtl": "newmtl a\nKd 1 0 0\nmap_Kd t.png\n", "t.png": png()})
    assert mesh.colour == Colour.TEXTURE
    assert mesh.corner_uvs.tolist() == [[[0, 0], [1, 0], [0, 1]]]
    assert mesh.face_textures.tolist() == [0]


def test_a_face_without_all_its_texture_coordinates_has_none() -> None:
    text = TEXTURED + "f 1/1 2 3\nf 1 2 3\n"
    mesh = read({"m.obj": text, "m.mtl": "newmtl a\nmap_Kd t.png\n", "t.png": png()})
    assert mesh.face_textures.tolist() == [0, -1, -1]


def test_numbers_of_texture_coordinates_that_nobody_wrote_are_ignored() -> None:
    assert len(read({"m.obj": f"{SQUARE}f 1/1 2/2 3/3\n"}).faces) == 1


def test_material_colours_go_to_the_faces_below_their_name() -> None:
    groups = f"usemtl red one\n{FACE}o x\nf 1 2 3 4\nusemtl blue\n{FACE}usemtl red one\n{FACE}"
    text = f"mtllib m.mtl\n{SQUARE}{FACE}{groups}"
    mesh = read({"m.obj": text, "m.mtl": "newmtl red one\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n"})
    assert mesh.colour == Colour.MATERIAL
    red, blue, grey = [1, 0, 0], [0, 0, 1], [0.5, 0.5, 0.5]
    assert mesh.corner_colours[:, 0].tolist() == [grey, red, red, red, blue, red]


def test_vertex_colours_are_read_and_partial_ones_dropped_with_a_warning() -> None:
    coloured = "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\n"
    mesh = read({"m.obj": coloured + FACE})
    assert mesh.colour == Colour.VERTEX
    assert mesh.corner_colours[0].tolist() == [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
    for vertex in ("v 1 1 1\n", "v 1 1 1 nan nan nan\n"):
        partial = read({"m.obj": coloured + vertex + FACE})
        assert partial.colour == Colour.NONE
        assert "only 3 of 4 vertices have a colour" in partial.warnings[0]


def test_a_weight_is_no_colour() -> None:
    assert read({"m.obj": "v 0 0 0 1\nv 1 0 0 1\nv 0 1 0 1\n" + FACE}).colour == Colour.NONE


@pytest.mark.parametrize(("level", "expected"), [("255", 1.0), ("51", 0.2), ("1.5", 1.0), ("-1", 0.0)])
def test_vertex_colours_beyond_one_are_whole_numbers_or_cut_off(level: str, expected: float) -> None:
    other = "255" if level in {"255", "51"} else "1.5"
    text = f"v 0 0 0 {level} 0 0\nv 1 0 0 {other} 0 0\nv 0 1 0 0 0 0\n" + FACE
    mesh = read({"m.obj": text})
    assert mesh.corner_colours[0, 0, 0] == pytest.approx(expected)
    assert "vertex colours" in mesh.warnings[0]


def test_many_groups_keep_their_own_materials() -> None:
    names = [f"m{place % 700}" for place in range(20_000)]
    text = "mtllib m.mtl\n" + SQUARE + "".join(f"usemtl {name}\n{FACE}" for name in names)
    mtl = "".join(f"newmtl m{place}\nKd {place / 1000} 0 0\n" for place in range(700))
    mesh = read({"m.obj": text, "m.mtl": mtl})
    expected = np.array([place % 700 for place in range(20_000)]) / 1000
    np.testing.assert_allclose(mesh.corner_colours[:, 0, 0], expected)


def test_blocks_join_without_a_seam(monkeypatch: pytest.MonkeyPatch) -> None:
    text = TRIANGLE + "usemtl a\n" + "v 5 5 5\nvt 1 1\nf -1/-1 -2/-2 1/1\nf 1 2 3\n" * 50
    whole = read({"m.obj": text})
    monkeypatch.setattr("worker.reading.words.blocks.__defaults__", (40,))
    cut = read({"m.obj": text})
    np.testing.assert_array_equal(cut.faces, whole.faces)
    np.testing.assert_array_equal(cut.corner_uvs, whole.corner_uvs)


@given(st.lists(st.sampled_from(LINES), max_size=25))
def test_any_mixture_of_lines_gives_valid_indices_or_a_refusal(lines: list[str]) -> None:
    files = {"m.obj": "\n".join(lines)}
    if attempt(lambda: read(files)) is None:
        mesh = read(files)
        assert mesh.faces.min() >= 0
        assert mesh.faces.max() < len(mesh.vertices)


@given(st.binary(max_size=200))
def test_random_bytes_are_refused(data: bytes) -> None:
    assert refusal({"m.obj": data})
