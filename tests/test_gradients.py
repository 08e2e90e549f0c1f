import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import Delaunay
from scipy.spatial.transform import Rotation

from tests.shapes import SQUARE, sheet, sphere
from worker.arrays import FloatArray, IntArray
from worker.geometry.areas import vertex_normals
from worker.geometry.gradients import gradient_operator, gradients, tangent_bases, tangent_hessians


def scattered(seed: int) -> tuple[FloatArray, IntArray]:
    """Triangulate 60 random points in a plane that is turned at random."""
    random = np.random.default_rng(seed)
    points = random.uniform(-1, 1, (60, 2))
    turn = Rotation.random(rng=random).as_matrix()
    return np.column_stack([points, np.zeros(60)]) @ turn.T, Delaunay(points).simplices.astype(np.int64)


@given(st.integers(0, 2**32 - 1))
def test_a_linear_function_on_a_plane_has_its_exact_gradient_everywhere(seed: int) -> None:
    vertices, faces = scattered(seed)
    slope = np.random.default_rng(seed + 1).standard_normal(3)
    normal = vertex_normals(vertices, faces)[0]
    along = slope - slope @ normal * normal
    found = gradients(gradient_operator(vertices, faces), vertices @ slope + 7.0)
    np.testing.assert_allclose(found, np.tile(along, (60, 1)), atol=1e-8)


def test_gradients_on_a_sphere_converge() -> None:
    errors = []
    for levels in (2, 3, 4):
        vertices, faces = sphere(levels)
        expected = np.array([0.0, 0.0, 1.0]) - vertices[:, 2:] * vertices  # of the height z
        found = gradients(gradient_operator(vertices, faces), vertices[:, 2])
        errors.append(np.sqrt(np.mean((found - expected) ** 2)))
    assert errors[0] > 2.5 * errors[1] > 2.5**2 * errors[2]  # each level halves the edges


def test_a_vertex_of_no_face_has_no_gradient() -> None:
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [5, 5, 5]])
    found = gradients(gradient_operator(vertices, SQUARE), vertices[:, 0])
    np.testing.assert_allclose(found, [[1.0, 0, 0]] * 4 + [[0.0, 0, 0]])


def test_faces_that_share_an_edge_three_times_each_count_by_their_area() -> None:
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1]])
    faces = np.array([[0, 1, 2], [1, 0, 3], [0, 1, 4]])
    values = np.array([0.0, 0, 3, 0, 0])  # rises in the first face only, which holds a third of the area
    found = gradients(gradient_operator(vertices, faces), values)
    np.testing.assert_allclose(found[0], [0, 1, 0], atol=1e-12)


def test_a_quadratic_on_a_plane_has_its_second_derivatives_inside() -> None:
    vertices, faces = sheet(20)
    x, y = vertices[:, 0], vertices[:, 1]
    operator = gradient_operator(vertices, faces)
    hessians = tangent_hessians(operator, 3.0 * x**2 + 2.0 * x * y - y**2, vertex_normals(vertices, faces))
    inside = (np.abs(vertices[:, :2] - 0.5) < 0.39).all(axis=1)
    expected = np.linalg.eigvalsh(np.array([[6.0, 2.0], [2.0, -2.0]]))
    found = np.linalg.eigvalsh(hessians[inside])
    np.testing.assert_allclose(found, np.tile(expected, (inside.sum(), 1)), atol=1e-9)


def test_the_height_of_a_sphere_bends_alike_in_all_directions() -> None:
    vertices, faces = sphere(4)
    hessians = tangent_hessians(gradient_operator(vertices, faces), vertices[:, 2], vertices)
    expected = -vertices[:, 2, None, None] * np.eye(2)  # the covariant Hessian of z
    assert np.sqrt(np.mean((hessians - expected) ** 2)) < 0.02


@given(st.integers(0, 2**32 - 1))
def test_tangent_bases_are_orthonormal_and_turn_left_around_the_normal(seed: int) -> None:
    normals = Rotation.random(20, rng=np.random.default_rng(seed)).apply([0.0, 0.0, 1.0])
    first, second = np.moveaxis(tangent_bases(normals), 1, 0)
    np.testing.assert_allclose(np.linalg.norm(first, axis=1), 1.0)
    np.testing.assert_allclose(np.cross(first, second), normals, atol=1e-12)
