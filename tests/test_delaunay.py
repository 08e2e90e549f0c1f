import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import Delaunay

from tests.shapes import sheet
from worker.arrays import FloatArray, IntArray
from worker.geometry.areas import edge_lengths, triangle_areas
from worker.geometry.delaunay import intrinsic_delaunay


def sorted_faces(faces: IntArray) -> IntArray:
    rows = np.sort(faces, axis=1)
    return rows[np.lexsort(rows.T[::-1])]


def opposite_angle_sums(faces: IntArray, lengths: FloatArray) -> FloatArray:
    """Sum for each pair of vertices the angles opposite to the edges between them."""
    a, b, c = lengths, np.roll(lengths, -1, axis=1), np.roll(lengths, 1, axis=1)
    angles = np.arccos(np.clip((b**2 + c**2 - a**2) / (2 * b * c), -1, 1)).ravel()
    tails, heads = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    keys = np.minimum(tails, heads) * faces.max() * 2 + np.maximum(tails, heads)
    _, inverse = np.unique(keys, return_inverse=True)
    return np.bincount(inverse, angles).astype(np.float64)


@given(st.integers(0, 2**32 - 1))
def test_in_the_plane_it_is_the_delaunay_triangulation(seed: int) -> None:
    random = np.random.default_rng(seed)
    vertices, faces = sheet(6)
    inside = np.abs(vertices[:, :2] - 0.5).max(axis=1) < 0.49
    vertices[inside, :2] += random.uniform(-0.04, 0.04, (inside.sum(), 2))  # keeps every triangle upright
    flipped, lengths = intrinsic_delaunay(faces, edge_lengths(vertices, faces))
    np.testing.assert_allclose(lengths, edge_lengths(vertices, flipped), rtol=1e-9)
    corners = np.array([0, 6, 42, 48])
    expected = Delaunay(vertices[:, :2]).simplices.astype(np.int64)
    interior = ~np.isin(expected, corners).any(axis=1) & inside[expected].any(axis=1)
    found = {tuple(face) for face in sorted_faces(flipped)}
    assert {tuple(face) for face in sorted_faces(expected[interior])} <= found


@given(st.integers(0, 2**32 - 1))
def test_the_area_stays_and_no_angle_sum_is_over_pi(seed: int) -> None:
    random = np.random.default_rng(seed)
    vertices, faces = sheet(8)
    vertices[:, 2] = 0.1 * random.standard_normal(len(vertices))
    before = edge_lengths(vertices, faces)
    flipped, lengths = intrinsic_delaunay(faces, before)
    # Every flip is inside the flat pair of its two triangles, so the sum of areas cannot change.
    np.testing.assert_allclose(triangle_areas(lengths).sum(), triangle_areas(before).sum(), rtol=1e-9)
    keys = np.sort(np.stack([flipped, np.roll(flipped, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    _, counts = np.unique(keys, axis=0, return_counts=True)
    if counts.max() <= 2:  # every edge is named by its ends
        assert opposite_angle_sums(flipped, lengths).max() < np.pi + 1e-6


def test_edges_of_three_faces_and_of_opposite_faces_stay() -> None:
    faces = np.array([[0, 1, 2], [1, 0, 3], [0, 1, 4]])
    lengths = np.array([[2.0, 1.01, 1.01]] * 3)
    flipped, _ = intrinsic_delaunay(faces, lengths)
    np.testing.assert_array_equal(flipped, faces)
    opposite = np.array([[0, 1, 2], [0, 1, 3]])
    np.testing.assert_array_equal(intrinsic_delaunay(opposite, lengths[:2])[0], opposite)
