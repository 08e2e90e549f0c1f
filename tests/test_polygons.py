"""Polygons keep their area, direction and order when they are split."""

import tracemalloc

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from worker.arrays import FloatArray
from worker.errors import Code, MeshError
from worker.reading.polygons import LONGEST, newell_normals, triangulate


def split(points: FloatArray) -> FloatArray:
    """Return the vector areas of the triangles of one polygon: (m, 3)."""
    corners = np.arange(len(points))
    triangles, _ = triangulate(points, corners, np.array([len(points)]))
    a, b, c = (points[triangles[:, corner]] for corner in range(3))
    areas: FloatArray = np.cross(b - a, c - a) / 2
    return areas


def star(radii: list[float]) -> FloatArray:
    """Return a polygon around the origin, often concave, in a tilted plane."""
    angles = np.arange(len(radii)) * 2 * np.pi / len(radii)
    flat = np.stack([np.cos(angles) * radii, np.sin(angles) * radii], axis=1)
    points: FloatArray = flat @ np.array([[1.0, 0.0, 0.3], [0.0, 1.0, -0.8]])
    return points


def test_a_long_polygon_needs_memory_for_its_corners_not_for_their_square() -> None:
    points = star([1.0, 2.0] * 2_000)
    tracemalloc.start()
    try:
        assert len(split(points)) == len(points) - 2
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak < 1_000 * len(points)  # bytes; eight times the square would be 128 MB


@given(st.lists(st.floats(0.1, 10), min_size=4, max_size=30))
def test_a_simple_polygon_is_covered_once_in_its_own_direction(radii: list[float]) -> None:
    points = star(radii)
    vector_area = newell_normals(points[None])[0] / 2
    areas = split(points)
    np.testing.assert_allclose(areas.sum(axis=0), vector_area, atol=1e-9)
    # Covered once: the areas add up without signs as well.
    np.testing.assert_allclose(
        np.linalg.norm(areas, axis=1).sum(), np.linalg.norm(vector_area), rtol=1e-9, atol=1e-9
    )


@given(st.lists(st.integers(3, 9), max_size=12))
def test_triangles_come_in_the_order_of_their_polygons(counts: list[int]) -> None:
    points = np.concatenate([star([1.0] * count) for count in counts] or [np.zeros((0, 3))])
    corners = np.arange(len(points))
    triangles, sources = triangulate(points, corners, np.array(counts, dtype=np.int64))
    assert sources.tolist() == [face for face, count in enumerate(counts) for _ in range(count - 2)]
    owner = np.repeat(np.arange(len(counts)), counts)
    assert (owner[triangles] == sources[:, None]).all()


@pytest.mark.parametrize("turn", range(4))
def test_a_quad_with_a_dent_is_split_along_its_inner_diagonal(turn: int) -> None:
    dart = np.array([[0.0, 0, 0], [4, 0, 0], [1, 1, 0], [0, 4, 0]])
    assert (split(np.roll(dart, turn, axis=0))[:, 2] > 0).all()


def test_a_twisted_quad_still_gives_two_triangles() -> None:
    bow_tie = np.array([[0.0, 0, 0], [1, 1, 0], [1, 0, 0], [0, 1, 0.2]])
    assert len(split(bow_tie)) == 2


def test_a_pentagram_does_not_pass_for_convex() -> None:
    angles = np.arange(5) * 4 * np.pi / 5
    points = np.stack([np.cos(angles), np.sin(angles), np.zeros(5)], axis=1)
    assert len(split(points)) <= 3


def test_a_polygon_of_one_point_gives_no_error() -> None:
    assert np.linalg.norm(split(np.ones((6, 3)))) == 0


def test_a_polygon_too_long_to_clip_is_refused() -> None:
    n = LONGEST + 1
    with pytest.raises(MeshError) as caught:
        triangulate(np.zeros((n, 3)), np.arange(n), np.array([n]))
    assert caught.value.code == Code.TOO_COMPLEX
