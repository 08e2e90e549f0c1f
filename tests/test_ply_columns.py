"""Lists end to end are found where they begin."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from worker.errors import Code, MeshError
from worker.reading.ply_columns import check_counts, positions, truncated
from worker.reading.ply_header import Element

FACES = Element(name="face", count=10, properties=())


@given(st.lists(st.tuples(st.integers(0, 99), st.integers(0, 5)), max_size=20))
def test_positions_are_those_of_each_list_in_turn(lists: list[tuple[int, int]]) -> None:
    starts = np.array([start for start, _ in lists], dtype=np.int64)
    counts = np.array([count for _, count in lists], dtype=np.int64)
    expected = [start + step for start, count in lists for step in range(count)]
    assert positions(starts, counts).tolist() == expected


def test_a_list_of_negative_length_is_refused_with_its_row() -> None:
    with pytest.raises(MeshError, match="face number 7 announces a list of -2") as caught:
        check_counts(np.array([3, -2]), FACES, before=5)
    assert caught.value.code == Code.BAD_DATA


def test_a_cut_file_says_what_was_announced_and_what_came() -> None:
    refusal = truncated(FACES, 4)
    assert refusal.code == Code.TRUNCATED
    assert "10 announced, 4 there" in refusal.detail
