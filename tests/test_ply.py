"""PLY files, from bytes to colours."""

import struct
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.mesh_files import area, attempt, ply_ascii, ply_binary, ply_header, png, read, refusal
from worker.errors import Code, MeshError
from worker.reading.limits import Limits
from worker.reading.mesh import Colour
from worker.reading.ply import read_ply

Write = Callable[..., bytes]  # a mesh as the bytes of a PLY
POINTS = np.array([[0.0, 0, 0], [4, 0, 0], [4, 4, 0], [2, 1, 0], [0, 4, 0]])
COLOURS = "property {0} red\nproperty {0} green\nproperty {0} blue\n"


@pytest.mark.parametrize("write", [ply_ascii, ply_binary, lambda v, f: ply_binary(v, f, ">")])
def test_every_form_of_a_concave_polygon_has_the_same_area(write: Write) -> None:
    mesh = read({"m.ply": write(POINTS, [[0, 1, 2, 3, 4], [0, 1, 2]])})
    assert area(mesh.vertices, mesh.faces) == pytest.approx(10 + 8)
    assert mesh.colour == Colour.NONE


@given(st.integers(0, 2**16 - 1))
def test_colours_are_scaled_by_their_declared_type(level: int) -> None:
    found = []
    for kind, form, most in (("uchar", "B", 255), ("ushort", "H", 65_535), ("float", "f", 1)):
        number = level / 65_535 if kind == "float" else round(level / 65_535 * most)
        vertex = struct.pack(f"<3f3{form}", 0, 0, 0, number, 0, 0)
        data = ply_header("binary_little_endian", 3, 1, COLOURS.format(kind)) + vertex * 3
        mesh = read({"m.ply": data + struct.pack("<B3i", 3, 0, 1, 2)})
        assert mesh.colour == Colour.VERTEX
        found.append(mesh.corner_colours[0, 0, 0])
    assert np.ptp(found) <= 1 / 255


@pytest.mark.parametrize("names", ["red green blue", "diffuse_red diffuse_green diffuse_blue", "r g b"])
def test_colours_go_by_several_names(names: str) -> None:
    extra = "".join(f"property uchar {name}\n" for name in names.split())
    data = ply_header("ascii", 3, 1, extra) + b"0 0 0 255 0 51\n" * 3 + b"3 0 1 2\n"
    assert read({"m.ply": data}).corner_colours[0, 0].tolist() == [1.0, 0.0, 0.2]


def test_face_colours_follow_their_polygon_through_the_split() -> None:
    header = ply_header("ascii", 5, 2).replace(
        b"end_header", COLOURS.format("uchar").encode() + b"end_header"
    )
    rows = b"".join(b"%d %d 0\n" % (x, y) for x, y, _ in POINTS.astype(int).tolist())
    mesh = read({"m.ply": header + rows + b"5 0 1 2 3 4 255 0 0\n3 0 1 2 0 255 0\n"})
    assert mesh.colour == Colour.FACE
    assert mesh.corner_colours[:, 0].tolist() == [[1, 0, 0]] * 3 + [[0, 1, 0]]


@pytest.mark.parametrize("level", ["nan", "inf"])
def test_colours_that_are_no_numbers_are_dropped_with_a_warning(level: str) -> None:
    data = (
        ply_header("ascii", 3, 1, COLOURS.format("float"))
        + f"0 0 0 {level} 0 0\n".encode() * 3
        + b"3 0 1 2\n"
    )
    mesh = read({"m.ply": data})
    assert mesh.colour == Colour.NONE
    assert "colours were dropped" in mesh.warnings[0]


def textured(names: str = "s t", comment: str = "t.png") -> bytes:
    extra = "".join(f"property float {name}\n" for name in names.split())
    header = ply_header("ascii", 3, 1, extra).replace(
        b"element vertex", f"comment TextureFile {comment}\nelement vertex".encode()
    )
    return header + b"0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n"


@pytest.mark.parametrize("names", ["s t", "u v", "texture_u texture_v"])
def test_texture_coordinates_of_vertices_go_by_several_names(names: str) -> None:
    mesh = read({"m.ply": textured(names), "t.png": png()})
    assert mesh.colour == Colour.TEXTURE
    assert mesh.corner_uvs[0].tolist() == [[0, 0], [1, 0], [0, 1]]


def test_a_texture_that_was_not_sent_or_lies_outside_is_refused() -> None:
    assert refusal({"m.ply": textured()}) == Code.MISSING_TEXTURE
    assert refusal({"m.ply": textured(comment="/etc/hostname")}) == Code.UNSAFE_REFERENCE
    assert read({"m.ply": textured()}, allow_untextured=True).colour == Colour.NONE


def test_faces_choose_their_texture_by_number_and_may_have_none() -> None:
    header = ply_header("ascii", 3, 4).replace(
        b"end_header", b"property list uchar float texcoord\nproperty int texnumber\nend_header"
    )
    header = header.replace(
        b"element vertex", b"comment TextureFile a.png\ncomment TextureFile b.png\nelement vertex"
    )
    uvs = b" 6 0 0 1 0 0 1 "
    rows = b"3 0 1 2" + uvs + b"1\n3 0 1 2 0 0\n3 0 1 2" + uvs + b"-1\n3 0 1 2" + uvs + b"0\n"
    mesh = read({"m.ply": header + b"0 0 0\n1 0 0\n0 1 0\n" + rows, "a.png": png(), "b.png": png()})
    assert mesh.face_textures.tolist() == [1, -1, -1, 0] or mesh.face_textures.tolist() == [0, -1, -1, 1]
    assert len(mesh.textures) == 2


@pytest.mark.parametrize(
    ("uvs", "code"), [("4 0 0 1 0", Code.BAD_DATA), ("6 0 0 nan 0 0 1", Code.NON_FINITE)]
)
def test_texture_coordinates_are_two_finite_numbers_a_corner(uvs: str, code: Code) -> None:
    header = ply_header("ascii", 3, 1).replace(
        b"end_header", b"property list uchar float texcoord\nend_header"
    )
    assert refusal({"m.ply": header + b"0 0 0\n" * 3 + f"3 0 1 2 {uvs}\n".encode()}) == code


def test_a_texture_covers_vertex_colours_and_says_so() -> None:
    data = textured().replace(b"element face", COLOURS.format("uchar").encode() + b"element face")
    data = data.replace(
        b"0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n", b"0 0 0 0 0 9 9 9\n1 0 0 1 0 9 9 9\n0 1 0 0 1 9 9 9\n"
    )
    mesh = read({"m.ply": data, "t.png": png()})
    assert mesh.colour == Colour.TEXTURE
    assert mesh.warnings == ("vertex colours give way to the texture",)


@pytest.mark.parametrize(
    ("face", "code"), [([0, 1, 5], Code.INDEX_OUT_OF_RANGE), ([0, 1, -1], Code.INDEX_OUT_OF_RANGE)]
)
def test_a_face_must_name_vertices_that_are_there(face: list[int], code: Code) -> None:
    assert refusal({"m.ply": ply_ascii(POINTS, [face])}) == code


def test_faces_of_two_corners_are_dropped_and_counted() -> None:
    mesh = read({"m.ply": ply_ascii(POINTS, [[0, 1], [0, 1, 2], []])})
    assert len(mesh.faces) == 1
    assert mesh.warnings == ("2 faces with fewer than three corners were dropped",)


@given(st.integers(0, 400), st.integers(0, 255), st.sampled_from([ply_ascii, ply_binary]))
def test_a_damaged_byte_gives_a_mesh_with_valid_indices_or_a_refusal(
    place: int, byte: int, write: Write
) -> None:
    data = bytearray(write(POINTS, [[0, 1, 2, 3], [0, 3, 4]] * 4))
    data[place % len(data)] = byte
    if attempt(lambda: read_ply(bytes(data), "m.ply", Limits())) is None:
        surface = read_ply(bytes(data), "m.ply", Limits())
        assert surface.corners.min(initial=0) >= 0
        assert surface.corners.max(initial=0) < len(surface.vertices)
        assert np.isfinite(surface.vertices).all()


@given(st.binary(max_size=100))
def test_random_bytes_are_refused(data: bytes) -> None:
    with pytest.raises(MeshError):
        read_ply(data, "m.ply", Limits())
