"""Corners in every form that OBJ knows."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from worker.errors import Code, MeshError
from worker.reading.obj_corners import Corners, read_corners
from worker.reading.words import split_words

NUMBER = st.integers(-999, 999).filter(bool)
CORNER = st.tuples(NUMBER, st.none() | NUMBER, st.none() | NUMBER)


def corners(text: str) -> Corners:
    words = split_words(text.encode())
    return read_corners(words, np.unique(words.lines))


def written(corner: tuple[int, int | None, int | None]) -> str:
    vertex, uv, normal = ("" if number is None else str(number) for number in corner)
    return f"{vertex}/{uv}/{normal}" if normal else f"{vertex}/{uv}" if uv else vertex


@given(st.lists(st.lists(CORNER, min_size=1, max_size=6), max_size=6))
def test_all_forms_mix(faces: list[list[tuple[int, int | None, int | None]]]) -> None:
    found = corners("\n".join(" ".join(map(written, face)) for face in faces))
    listed = [corner for face in faces for corner in face]
    assert found.counts.tolist() == [len(face) for face in faces]
    assert found.vertices.tolist() == [vertex for vertex, _, _ in listed]
    assert found.uvs.tolist() == [uv or 0 for _, uv, _ in listed]
    assert found.has_uv.tolist() == [uv is not None for _, uv, _ in listed]


def test_slashes_without_numbers_name_nothing() -> None:
    found = corners("1// 2/ 3/4/")
    assert found.vertices.tolist() == [1, 2, 3]
    assert found.has_uv.tolist() == [False, False, True]


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("1/2/3/4", Code.BAD_DATA),
        ("1.5", Code.BAD_NUMBER),
        ("a/1", Code.BAD_NUMBER),
        ("1/x", Code.BAD_NUMBER),
    ],
)
def test_what_is_no_corner_is_refused(text: str, code: Code) -> None:
    with pytest.raises(MeshError, match="Line 1") as caught:
        corners(text)
    assert caught.value.code == code
