import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from tests.shapes import SQUARE, box, sphere
from worker.geometry.edges import find_edges, lengths_of, stable_order


def test_a_closed_surface_has_three_edges_for_every_two_faces() -> None:
    _, faces = sphere(3)
    edges = find_edges(faces)
    assert len(edges.ends) == 3 * len(faces) // 2
    assert (edges.n_faces == 2).all()


def test_a_square_has_four_outer_edges_and_a_diagonal() -> None:
    edges = find_edges(SQUARE)
    assert sorted(map(tuple, edges.ends.tolist())) == [(0, 1), (0, 2), (0, 3), (1, 2), (2, 3)]
    assert edges.n_faces.tolist() == [2 if tuple(ends) == (0, 2) else 1 for ends in edges.ends.tolist()]


def test_each_face_names_its_edges_in_order() -> None:
    _, faces, _ = box()
    edges = find_edges(faces)
    for corner in range(3):
        ends = np.sort(faces[:, [corner, (corner + 1) % 3]], axis=1)
        np.testing.assert_array_equal(edges.ends[edges.of_faces[:, corner]], ends)


def test_lengths_are_euclidean() -> None:
    vertices, faces, _ = box()
    lengths = lengths_of(vertices, find_edges(faces))
    np.testing.assert_allclose(np.sort(lengths), np.sort([1.0] * 12 + [np.sqrt(2.0)] * 6))


@given(st.lists(st.sampled_from([0, 1, 7, 1 << 40, (1 << 62) - 1])))
def test_the_order_sorts_and_keeps_equal_keys_as_they_stand(keys: list[int]) -> None:
    expected = sorted(range(len(keys)), key=lambda place: keys[place])
    np.testing.assert_array_equal(stable_order(np.array(keys, dtype=np.int64)), expected)
