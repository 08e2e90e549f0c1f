"""Neighbours agree on what is outside, where they can."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from tests.shapes import icosahedron
from worker.arrays import IntArray
from worker.geometry.orientation import face_edges, flipped_faces, undirected


def turned(faces: IntArray, chosen: list[int]) -> IntArray:
    faces = faces.copy()
    faces[chosen] = faces[chosen][:, [0, 2, 1]]
    return faces


@given(st.sets(st.integers(0, 19), max_size=9))
def test_the_smaller_part_is_turned_back(chosen: set[int]) -> None:
    _, faces = icosahedron()
    flipped, orientable = flipped_faces(turned(faces, sorted(chosen)))
    assert np.flatnonzero(flipped).tolist() == sorted(chosen)
    assert orientable


@given(st.sets(st.integers(0, 39), max_size=40))
def test_every_edge_of_two_faces_is_run_both_ways_in_each_piece(chosen: set[int]) -> None:
    _, faces = icosahedron()
    mixed = turned(np.concatenate([faces, faces + 12]), sorted(chosen))
    flipped, _ = flipped_faces(mixed)
    directed = face_edges(turned(mixed, np.flatnonzero(flipped).tolist()))
    assert len(np.unique(directed, axis=0)) == len(directed)


def test_a_moebius_strip_stays_as_it_is() -> None:
    n = 8
    low, high = np.arange(n), np.arange(n) + n
    next_low, next_high = np.roll(low, -1), np.roll(high, -1)
    next_low[-1], next_high[-1] = high[0], low[0]
    strip = np.concatenate([np.stack([low, next_low, high], 1), np.stack([high, next_low, next_high], 1)])
    flipped, orientable = flipped_faces(strip)
    assert not orientable
    assert not flipped.any()


def test_edges_of_three_faces_pass_nothing_on() -> None:
    book = np.array([[0, 1, 2], [0, 1, 3], [0, 1, 4]])
    flipped, orientable = flipped_faces(book)
    assert orientable
    assert not flipped.any()


def test_an_edge_has_one_number_in_both_directions() -> None:
    numbers = undirected(np.array([[0, 5], [5, 0], [1, 5], [0, 1]]))
    assert numbers[0] == numbers[1]
    assert np.unique(numbers).size == 3
