import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.shapes import box, sphere
from worker.geometry.areas import (
    edge_lengths,
    face_vectors,
    norms,
    triangle_areas,
    vertex_areas,
    vertex_normals,
)


def test_a_right_triangle_has_half_the_product_of_its_legs() -> None:
    assert triangle_areas(np.array([[3.0, 5.0, 4.0]]))[0] == 6.0


def test_an_impossible_triangle_has_no_area() -> None:
    assert triangle_areas(np.array([[1.0, 1.0, 2.0 + 1e-15]]))[0] == 0.0


@given(st.integers(0, 2**32 - 1))
def test_areas_from_lengths_equal_areas_from_cross_products(seed: int) -> None:
    vertices = np.random.default_rng(seed).standard_normal((30, 3))
    faces = np.arange(30).reshape(-1, 3)
    expected = np.linalg.norm(face_vectors(vertices, faces), axis=1)
    np.testing.assert_allclose(triangle_areas(edge_lengths(vertices, faces)), expected, rtol=1e-9)


def test_vertex_areas_sum_to_the_surface() -> None:
    vertices, faces, _ = box()
    areas = vertex_areas(faces, triangle_areas(edge_lengths(vertices, faces)), len(vertices))
    np.testing.assert_allclose(areas.sum(), 6.0)


def test_the_normals_of_a_sphere_are_its_points() -> None:
    vertices, faces = sphere(3)
    np.testing.assert_allclose(vertex_normals(vertices, faces), vertices, atol=2e-2)


@pytest.mark.parametrize("shape", [(50, 2), (50, 3), (20, 3, 6)])
def test_norms_are_lengths(shape: tuple[int, ...]) -> None:
    vectors = np.random.default_rng(1).standard_normal(shape)
    np.testing.assert_allclose(norms(vectors), np.linalg.norm(vectors, axis=-1), rtol=1e-14)
