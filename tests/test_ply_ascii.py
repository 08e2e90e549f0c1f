"""PLY bodies as text: a line is a row, neither more nor less."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.mesh_files import ply_ascii, ply_header
from worker.errors import Code, MeshError
from worker.reading.ply_ascii import read_ascii
from worker.reading.ply_columns import Body
from worker.reading.ply_header import read_header

POINTS = np.linspace(-1, 1, 15).reshape(5, 3)
FACES = st.lists(st.lists(st.integers(0, 4), min_size=0, max_size=6), min_size=1, max_size=12)


def body(data: bytes) -> Body:
    return read_ascii(data, read_header(data))


def refused(data: bytes) -> Code:
    with pytest.raises(MeshError) as caught:
        body(data)
    return caught.value.code


@given(FACES, st.sampled_from([b"\n", b"\r\n", b"\r", b" \n\n\t"]))
def test_rows_of_any_length_are_read_as_written(faces: list[list[int]], end: bytes) -> None:
    data = ply_ascii(POINTS, faces)
    start = read_header(data).body
    found = body(data[:start] + data[start:].replace(b"\n", end))
    np.testing.assert_array_equal(found["vertex"].scalars["z"], POINTS[:, 2].astype(np.float32).astype(float))
    lists = found["face"].lists["vertex_indices"]
    assert lists.counts.tolist() == [len(face) for face in faces]
    assert lists.values.tolist() == [corner for face in faces for corner in face]


@given(FACES, st.data())
def test_no_beginning_that_lacks_a_number_passes_for_the_whole(
    faces: list[list[int]], data: st.DataObject
) -> None:
    whole = ply_ascii(POINTS, faces)
    last_number = max(whole.rstrip().rfind(b" "), whole.rstrip().rfind(b"\n"))
    end = data.draw(st.integers(read_header(whole).body, last_number))
    assert refused(whole[:end]) in {Code.TRUNCATED, Code.BAD_NUMBER, Code.BAD_DATA}


def test_a_file_without_a_last_line_end_is_whole() -> None:
    assert body(ply_ascii(POINTS, [[0, 1, 2]])[:-1])["face"].lists["vertex_indices"].values.size == 3


@pytest.mark.parametrize(
    ("rows", "code"),
    [
        (b"3 0 1 2\n3 0 1", Code.TRUNCATED),
        (b"3 0 1 2\n3 0 1\n", Code.BAD_DATA),
        (b"3 0 1 2\n", Code.TRUNCATED),
        (b"3 0 1 2\n3 0 1 2\n3 0 1 2\n", Code.TRAILING_DATA),
        (b"3 0 1 2 3\n4 0 1 2\n", Code.BAD_DATA),
        (b"3 0 1 2 9\n3 0 1 2\n", Code.BAD_DATA),
        (b"-1\n3 0 1 2\n", Code.BAD_DATA),
        (b"2.5 0 1 2\n3 0 1 2\n", Code.BAD_DATA),
        (b"999 0 1 2\n3 0 1 2\n", Code.BAD_DATA),
        (b"3 0 1 1e20\n3 0 1 2\n", Code.BAD_DATA),
        (b"3 0 1 nan\n3 0 1 2\n", Code.BAD_DATA),
        (b"nan 0 1 2\n3 0 1 2\n", Code.BAD_DATA),
        (b"3 0 1 x\n3 0 1 2\n", Code.BAD_NUMBER),
    ],
)
def test_rows_that_contradict_the_header_or_themselves_are_refused(rows: bytes, code: Code) -> None:
    assert refused(ply_header("ascii", 1, 2) + b"0 0 0\n" + rows) == code


def test_numbers_to_spare_in_vertices_are_refused() -> None:
    assert refused(ply_header("ascii", 2, 0) + b"0 0 0 1\n0 0 0 1\n") == Code.BAD_DATA


def test_the_colours_that_meshlab_once_wrote_as_undeclared_lists_are_ignored() -> None:
    header = ply_header("ascii", 3, 2).replace(b"end_header", b"property uchar red\nend_header")
    found = body(header + b"0 0 0\n" * 3 + b"3 0 1 2 9 1 1\n" * 2)
    assert found["face"].lists["vertex_indices"].values.tolist() == [0, 1, 2] * 2
    assert found["face"].scalars == {}
