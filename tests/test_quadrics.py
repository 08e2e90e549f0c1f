import numpy as np

from tests.shapes import sheet, sphere
from worker.arrays import FloatArray
from worker.geometry.quadrics import plane_quadrics


def least(quadrics: FloatArray) -> FloatArray:
    """Return the points where the sums of squares are least, (n, 3)."""
    matrices = quadrics[:, [0, 1, 2, 1, 3, 4, 2, 4, 5]].reshape(-1, 3, 3)
    return np.asarray(np.linalg.solve(matrices, quadrics[:, 6:, None])[:, :, 0])


def test_planes_of_a_vertex_meet_in_it() -> None:
    vertices, faces = sphere(2)
    quadrics = plane_quadrics(vertices, faces, np.zeros(faces.shape, dtype=np.bool_))
    np.testing.assert_allclose(least(quadrics), vertices, atol=1e-9)


def test_the_planes_of_faces_weigh_their_areas() -> None:
    vertices = np.array([[0.0, 0, 1], [2, 0, 1], [0, 3, 1]])
    quadrics = plane_quadrics(vertices, np.array([[0, 1, 2]]), np.zeros((1, 3), dtype=np.bool_))
    np.testing.assert_allclose(quadrics, [[0, 0, 0, 0, 0, 3, 0, 0, 3]] * 3)  # 3 (z − 1)²


def test_an_open_edge_keeps_its_line() -> None:
    vertices, faces = sheet(1)
    open_sides = np.array([[True, True, False], [False, True, True]])
    quadrics = plane_quadrics(vertices, faces, open_sides)
    np.testing.assert_allclose(least(quadrics), vertices, atol=1e-12)  # two borders and the plane
