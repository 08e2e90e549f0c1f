"""Normals are smooth where the surface is, and light comes from above."""

import numpy as np

from worker.arrays import FloatArray
from worker.pictures.camera import camera_axes
from worker.pictures.shading import corner_normals, shade

FACES = np.array([(0, 1, 2), (1, 0, 3)])


def _roof(angle: float) -> FloatArray:
    """Return four vertices of two triangles along the x axis, the second turned up by ``angle`` degrees."""
    rise = np.radians(angle)
    return np.array([(0, 0, 0), (1, 0, 0), (0.5, 1, 0), (0.5, -np.cos(rise), np.sin(rise))])


def test_a_gentle_edge_is_shown_smooth() -> None:
    normals = corner_normals(_roof(20), FACES, np.array([0, 1]))
    np.testing.assert_allclose(normals[0, 0], normals[1, 1])


def test_a_sharp_edge_is_shown_sharp() -> None:
    normals = corner_normals(_roof(120), FACES, np.array([0]))
    np.testing.assert_allclose(normals[0], [(0, 0, 1)] * 3, atol=1e-12)


def test_light_comes_from_above() -> None:
    axes = camera_axes()
    grey = np.full((2, 3), 0.5)
    above, below = shade(grey, np.array([(0.0, 1.0, 0.0), (0.0, -1.0, 0.3)]), axes)
    assert above[0] > below[0]


def test_a_normal_and_its_opposite_are_lit_alike() -> None:
    normals = np.random.default_rng(0).normal(size=(20, 3))
    grey = np.full((20, 3), 0.5)
    np.testing.assert_allclose(shade(grey, normals, camera_axes()), shade(grey, -normals, camera_axes()))
