"""Surface nets are closed, lie on the zero level, and have the area of what they show."""

import numpy as np
import pytest
from scipy.spatial import KDTree

from service.samples.shell import triangles
from service.samples.surface import polygonise
from worker.arrays import BoolArray, FloatArray


class Ball:
    """The unit ball as a field."""

    def __call__(self, points: FloatArray) -> FloatArray:
        """Return the distance to the sphere."""
        return np.asarray(np.linalg.norm(points, axis=1) - 1.0)

    def near(self, points: FloatArray, radius: float) -> BoolArray:
        """Say whether the sphere is so near."""
        return np.asarray(np.abs(self(points)) <= radius)


BOX = (np.full(3, -1.1), np.full(3, 1.1))


@pytest.mark.parametrize("offset", [0.0, 0.5])
def test_a_ball_becomes_a_closed_sphere(offset: float) -> None:
    vertices, quads = polygonise(Ball(), *BOX, n_vertices=2000, offset=offset)
    assert 1700 < len(vertices) < 2300
    np.testing.assert_allclose(np.linalg.norm(vertices, axis=1), 1.0, atol=1e-4)
    edges = np.sort(np.vstack([quads[:, [i, (i + 1) % 4]] for i in range(4)]), axis=1)
    unique, counts = np.unique(edges, axis=0, return_counts=True)
    assert (counts == 2).all()
    assert len(vertices) - len(unique) + len(quads) == 2


def test_faces_look_outwards_and_enclose_the_ball() -> None:
    vertices, quads = polygonise(Ball(), *BOX, n_vertices=3000)
    volume = np.linalg.det(vertices[triangles(vertices, quads)]).sum() / 6
    assert volume == pytest.approx(4 / 3 * np.pi, rel=0.01)


def test_another_offset_gives_other_vertices() -> None:
    first = polygonise(Ball(), *BOX, n_vertices=1000)[0]
    second = polygonise(Ball(), *BOX, n_vertices=1000, offset=0.4)[0]
    assert np.mean(KDTree(second).query(first)[0] > 1e-4) > 0.95
