"""Neighbours agree on what is outside, where they can."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from tests.shapes import icosahedron
from worker.arrays import BoolArray, IntArray
from worker.geometry.edges import find_edges
from worker.geometry.orientation import flipped_faces


def flipped(faces: IntArray) -> tuple[BoolArray, bool]:
    return flipped_faces(faces, find_edges(faces))


def face_edges(faces: IntArray) -> IntArray:
    """Return the directed edges of faces (m, 3); (3 m, 2)."""
    return np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])


def turned(faces: IntArray, chosen: list[int]) -> IntArray:
    faces = faces.copy()
    faces[chosen] = faces[chosen][:, [0, 2, 1]]
    return faces


@given(st.sets(st.integers(0, 19), max_size=9))
def test_the_smaller_part_is_turned_back(chosen: set[int]) -> None:
    _, faces = icosahedron()
    turned_back, orientable = flipped(turned(faces, sorted(chosen)))
    assert np.flatnonzero(turned_back).tolist() == sorted(chosen)
    assert orientable


@given(st.sets(st.integers(0, 39), max_size=40))
def test_every_edge_of_two_faces_is_run_both_ways_in_each_piece(chosen: set[int]) -> None:
    _, faces = icosahedron()
    mixed = turned(np.concatenate([faces, faces + 12]), sorted(chosen))
    turned_back, _ = flipped(mixed)
    directed = face_edges(turned(mixed, np.flatnonzero(turned_back).tolist()))
    assert len(np.unique(directed, axis=0)) == len(directed)


def test_a_moebius_strip_stays_as_it_is() -> None:
    n = 8
    low, high = np.arange(n), np.arange(n) + n
    next_low, next_high = np.roll(low, -1), np.roll(high, -1)
    next_low[-1], next_high[-1] = high[0], low[0]
    strip = np.concatenate([np.stack([low, next_low, high], 1), np.stack([high, next_low, next_high], 1)])
    turned_back, orientable = flipped(strip)
    assert not orientable
    assert not turned_back.any()


def test_edges_of_three_faces_pass_nothing_on() -> None:
    book = np.array([[0, 1, 2], [0, 1, 3], [0, 1, 4]])
    turned_back, orientable = flipped(book)
    assert orientable
    assert not turned_back.any()


def test_of_two_equal_halves_the_first_face_stays() -> None:
    turned_back, _ = flipped(np.array([[0, 1, 2], [0, 1, 3]]))
    assert turned_back.tolist() == [False, True]
