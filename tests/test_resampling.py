import numpy as np
import pytest

from tests.shapes import box, sheet, sphere
from worker.arrays import FloatArray, IntArray
from worker.errors import Code, MeshError
from worker.geometry.areas import face_vectors
from worker.geometry.edges import find_edges, lengths_of
from worker.geometry.resampling import edge_of, resample, sample_surface


@pytest.mark.parametrize(
    "mesh",
    [box()[:2], sphere(2), sphere(5), sheet(120), sphere(6)],
    ids=["box", "coarse", "fine", "open", "very fine"],
)
def test_any_resolution_becomes_the_canonical_one(mesh: tuple[FloatArray, IntArray]) -> None:
    vertices, faces = resample(*mesh, 19_000.0, 5_000)
    assert len(vertices) == 5_000
    lengths = lengths_of(vertices, find_edges(faces))
    np.testing.assert_allclose(lengths.mean(), edge_of(19_000.0, 5_000), rtol=0.1)
    np.testing.assert_allclose(np.linalg.norm(face_vectors(vertices, faces), axis=1).sum(), 19_000.0)


def tube(n: int, length: float) -> tuple[FloatArray, IntArray]:
    """Return a tube of radius 1 from 2 n needles."""
    angles = 2 * np.pi * np.arange(n) / n
    ring = np.column_stack([np.cos(angles), np.sin(angles), np.zeros(n)])
    here, there = np.arange(n), (np.arange(n) + 1) % n
    faces = [np.column_stack([here, there, here + n]), np.column_stack([there, there + n, here + n])]
    return np.vstack([ring, ring + [0, 0, length]]), np.vstack(faces)


def test_a_surface_too_long_and_thin_for_its_area_is_refused_early() -> None:
    with pytest.raises(MeshError, match="long and thin") as caught:
        resample(*tube(24, 1e8), 19_000.0, 500)
    assert caught.value.code == Code.TOO_COMPLEX


def test_many_vertices_as_such_are_no_reason_to_refuse() -> None:
    vertices, faces = sphere(5)  # 10 242 vertices for 20
    assert len(resample(vertices, faces, 19_000.0, 20)[0]) == 20


def test_needles_do_not_become_ever_more_needles() -> None:
    vertices, _ = resample(*tube(24, 400.0), 19_000.0, 2_000)
    assert len(vertices) == 2_000
    np.testing.assert_allclose(np.ptp(vertices[:, 2]), 400.0 * np.sqrt(19_000.0 / (800.0 * np.pi)), rtol=0.1)


def test_an_even_triangulation_of_a_human_body_has_edges_of_two_centimetres() -> None:
    np.testing.assert_allclose(edge_of(19_000.0, 5_000), 2.1, atol=0.05)


def test_samples_are_spread_by_area() -> None:
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [10, 0, 0], [13, 0, 0], [10, 2, 0]])
    faces = np.array([[0, 1, 2], [3, 4, 5]])  # areas ½ and 3
    indices, barycentrics = sample_surface(vertices, faces, 7_000)
    assert np.count_nonzero(indices == 0) == 1_000
    assert (barycentrics >= 0).all()
    np.testing.assert_allclose(barycentrics.sum(axis=1), 1.0)
    np.testing.assert_allclose(barycentrics[indices == 1].mean(axis=0), 1 / 3, atol=2e-3)


def test_the_same_mesh_gives_the_same_bits() -> None:
    first, second = (resample(*sphere(5), 19_000.0, 2_000) for _ in range(2))
    assert first[0].tobytes() == second[0].tobytes()
    assert first[1].tobytes() == second[1].tobytes()
