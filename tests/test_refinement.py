import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from tests.shapes import box, sphere
from worker.arrays import FloatArray, IntArray
from worker.geometry.areas import edge_lengths, face_vectors
from worker.geometry.edges import find_edges
from worker.geometry.refinement import split_long_edges


def area(vertices: FloatArray, faces: IntArray) -> float:
    return float(np.linalg.norm(face_vectors(vertices, faces), axis=1).sum())


@given(st.floats(0.02, 2.0))
def test_no_edge_stays_longer_than_allowed_and_the_area_stays(longest: float) -> None:
    vertices, faces, _ = box()
    finer, triangles = split_long_edges(vertices, faces, longest)
    assert edge_lengths(finer, triangles).max() <= longest
    np.testing.assert_allclose(area(finer, triangles), 6.0)


def test_a_closed_surface_stays_closed() -> None:
    vertices, faces = sphere(1)
    finer, triangles = split_long_edges(vertices, faces, 0.1)
    edges = find_edges(triangles)
    assert (edges.n_faces == 2).all()
    assert len(finer) - len(edges.ends) + len(triangles) == 2  # Euler
