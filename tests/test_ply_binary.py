"""Binary PLY bodies: what is written is read, what is cut is refused."""

import struct

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.mesh_files import ply_binary, ply_header
from worker.errors import Code, MeshError
from worker.reading.ply_binary import read_binary
from worker.reading.ply_columns import Body
from worker.reading.ply_header import read_header

POINTS = np.arange(15, dtype=np.float64).reshape(5, 3)
FACES = st.lists(st.lists(st.integers(0, 4), min_size=0, max_size=6), min_size=1, max_size=12)


def body(data: bytes) -> Body:
    return read_binary(data, read_header(data))


def refused(data: bytes) -> Code:
    with pytest.raises(MeshError) as caught:
        body(data)
    return caught.value.code


@given(FACES, st.sampled_from("<>"))
def test_lists_of_any_lengths_are_read_as_written(faces: list[list[int]], order: str) -> None:
    found = body(ply_binary(POINTS, faces, order))
    np.testing.assert_array_equal(found["vertex"].scalars["y"], POINTS[:, 1])
    lists = found["face"].lists["vertex_indices"]
    assert lists.counts.tolist() == [len(face) for face in faces]
    assert lists.values.tolist() == [corner for face in faces for corner in face]


@given(FACES, st.data())
def test_no_beginning_of_a_file_passes_for_the_whole(faces: list[list[int]], data: st.DataObject) -> None:
    whole = ply_binary(POINTS, faces)
    start = read_header(whole).body
    end = data.draw(st.integers(start, len(whole) - 1))
    assert refused(whole[:end]) in {Code.TRUNCATED, Code.BAD_DATA}


@given(FACES, st.binary(min_size=1, max_size=20))
def test_bytes_after_the_end_are_refused(faces: list[list[int]], more: bytes) -> None:
    assert refused(ply_binary(POINTS, faces) + more) in {Code.TRAILING_DATA, Code.BAD_DATA}


def test_other_elements_and_properties_of_every_type_are_stepped_over() -> None:
    extra = "property double w\nproperty list ushort short near\nproperty uchar c\n"
    header = ply_header("binary_big_endian", 2, 1, extra).replace(
        b"element face", b"element edge 2\nproperty list int8 float64 lengths\nproperty uint id\nelement face"
    )
    data = header
    for near in ([7, -8], []):
        data += struct.pack(">3fdH", 1, 2, 3, 4.5, len(near)) + struct.pack(f">{len(near)}hB", *near, 9)
    data += struct.pack(">bdI", 1, 0.5, 70_000) + struct.pack(">bI", 0, 4_000_000_000)
    data += struct.pack(">B3i", 3, 0, 1, 0)
    found = body(data)
    assert found["vertex"].scalars["w"].tolist() == [4.5, 4.5]
    assert found["vertex"].lists["near"].values.tolist() == [7, -8]
    assert found["vertex"].lists["near"].counts.tolist() == [2, 0]
    assert found["vertex"].scalars["c"].tolist() == [9, 9]
    assert found["edge"].scalars["id"].tolist() == [70_000, 4_000_000_000]
    assert found["face"].lists["vertex_indices"].values.tolist() == [0, 1, 0]


def test_a_face_that_lies_about_its_length_is_told_from_a_cut_file() -> None:
    data = bytearray(ply_binary(POINTS, [[0, 1, 2]] * 9))
    data[-26] = 4  # the last but one says four; the file's size fits triangles
    assert refused(bytes(data)) == Code.BAD_DATA


def test_a_negative_length_is_refused() -> None:
    header = ply_header("binary_little_endian", 0, 2).replace(b"list uchar", b"list char")
    assert refused(header + struct.pack("<b3ib", 3, 0, 0, 0, -1)) == Code.BAD_DATA


def test_a_length_past_the_end_allocates_nothing() -> None:
    header = ply_header("binary_little_endian", 0, 1).replace(b"list uchar", b"list uint")
    assert refused(header + struct.pack("<I3i", 2**32 - 1, 0, 0, 0)) == Code.TRUNCATED
