"""A PLY header is held to what it says."""

import time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.mesh_files import attempt, ply_header
from worker.errors import Code, MeshError
from worker.reading.limits import Limits
from worker.reading.ply_header import check_promise, read_header

GOOD = ply_header("ascii", 3, 1)


def refused(data: bytes) -> Code:
    with pytest.raises(MeshError) as caught:
        check_promise(read_header(data), len(data), Limits())
    return caught.value.code


@pytest.mark.parametrize("end", [b"\n", b"\r\n", b"\r"])
@pytest.mark.parametrize("mark", [b"", b"\xef\xbb\xbf"])
def test_the_body_begins_after_one_line_end_of_any_system(end: bytes, mark: bytes) -> None:
    data = mark + GOOD.replace(b"\n", end)
    header = read_header(data + b"\n\x01")  # the body's first byte looks like a line end
    assert header.body == len(data)
    assert [element.name for element in header.elements] == ["vertex", "face"]


def test_a_header_of_many_properties_and_elements_takes_no_time_squared() -> None:
    lines = [f"property float p{number}" for number in range(36_000)]
    lines += [f"element e{number} 0\nproperty char a" for number in range(5_000)]
    data = GOOD.replace(b"element face", "\n".join([*lines, "element face"]).encode())
    start = time.process_time()
    header = read_header(data)
    assert time.process_time() - start < 10  # a second or less; a minute where each name meets all others
    assert len(header.elements) == 5_002
    assert len(header.elements[0].properties) == 36_003


def test_textures_are_named_by_comments() -> None:
    data = GOOD.replace(b"element vertex", b"comment TextureFile   fuze uv.jpg \nelement vertex")
    assert read_header(data).texture_files == ("fuze uv.jpg",)


def test_a_line_without_meaning_is_skipped_with_a_warning() -> None:
    header = read_header(GOOD.replace(b"element vertex", b"Created by hand\nelement vertex"))
    assert "Created by hand" in header.warnings[0]


@pytest.mark.parametrize(
    ("old", "new", "code"),
    [
        (b"format ascii 1.0\n", b"", Code.BAD_HEADER),
        (b"format ascii 1.0", b"format ascii 2.0", Code.BAD_HEADER),
        (b"format ascii 1.0", b"format utf8 1.0", Code.BAD_HEADER),
        (b"element face 1", b"element \x1b[31m 1\nelement face 1", Code.BAD_HEADER),
        (b"element face 1", b"element " + b"a" * 101 + b" 1\nelement face 1", Code.BAD_HEADER),
        (b"format ascii 1.0\n", b"format ascii 1.0\nformat ascii 1.0\n", Code.BAD_HEADER),
        (b"vertex 3", b"vertex -5", Code.BAD_HEADER),
        (b"vertex 3", b"vertex three", Code.BAD_HEADER),
        (b"vertex 3", b"vertex 4000000000", Code.TRUNCATED),
        (b"float x", b"float a", Code.BAD_HEADER),
        (b"float x", b"float y", Code.BAD_HEADER),
        (b"float x", b"quad x", Code.BAD_HEADER),
        (b"list uchar", b"list float", Code.BAD_HEADER),
        (b"uchar int", b"uchar float", Code.BAD_HEADER),
        (b"vertex_indices", b"corners", Code.BAD_HEADER),
        (b"face 1", b"vertex 1", Code.BAD_HEADER),
        (b"element vertex 3\n", b"", Code.BAD_HEADER),
        (b"face 1", b"face 0", Code.NO_FACES),
        (b"face 1", b"tristrips 1", Code.UNSUPPORTED),
        (b"end_header", b"", Code.TRUNCATED),
        (b"end_header\n", b"end_header of it\n", Code.BAD_HEADER),
        (b"ply\n", b"plyx\n", Code.NOT_PLY),
        (b"ply\n", b"v 0 0 0\n", Code.NOT_PLY),
    ],
)
def test_a_header_that_cannot_be_right_is_refused(old: bytes, new: bytes, code: Code) -> None:
    assert refused(GOOD.replace(old, new, 1)) == code


@pytest.mark.parametrize(
    "data", [b"", b" \n", b"ply\nformat ascii 1.0\nend_header\n", ply_header("ascii", 0, 0)]
)
def test_a_file_that_announces_nothing_is_empty(data: bytes) -> None:
    assert refused(data) == Code.EMPTY


def test_more_rows_than_the_limit_are_refused() -> None:
    data = GOOD.replace(b"face 1", b"face 1000")
    with pytest.raises(MeshError) as caught:
        check_promise(read_header(data), 10**9, Limits(faces=999))
    assert caught.value.code == Code.TOO_COMPLEX


@given(st.binary(max_size=300), st.integers(0, len(GOOD)))
def test_any_bytes_are_a_header_or_a_refusal(junk: bytes, place: int) -> None:
    data = GOOD[:place] + junk + GOOD[place:]
    kinds = {None, Code.BAD_HEADER, Code.TRUNCATED, Code.NOT_PLY, Code.EMPTY}
    assert attempt(lambda: read_header(data)) in kinds
