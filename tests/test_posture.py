"""Posture: distances between points, which turning, mirroring and meshing leave as they are."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from tests.shapes import sphere
from worker.arrays import FloatArray
from worker.descriptors.posture import STEP, STEPS, posture, posture_distance
from worker.solving import areas_of


def ball(levels: int, radius: float) -> tuple[FloatArray, FloatArray]:
    """Return the vertices of a sphere and their areas."""
    vertices, faces = sphere(levels)
    return radius * vertices, areas_of(radius * vertices, faces)


def bent(angle: float) -> tuple[FloatArray, FloatArray]:
    """Return points of a rod that is bent in the middle, and equal areas."""
    along = np.linspace(-1.0, 1.0, 300)
    other = np.where(along > 0, along, 0.0)
    points = np.column_stack([along - other + other * np.cos(angle), other * np.sin(angle), 0 * along])
    return 100.0 * points, np.ones(300)


def test_chords_of_a_sphere_are_distributed_as_they_should_be() -> None:
    radius = 40.0
    found = posture(*ball(4, radius))
    lengths = STEP * np.arange(1, STEPS + 1)
    expected = np.minimum(lengths / (2.0 * radius), 1.0) ** 2  # chord length of two uniform points
    assert np.abs(found - expected).max() < 0.02


@given(st.integers(0, 2**32 - 1), st.booleans())
def test_turning_shifting_and_mirroring_change_nothing(seed: int, mirrored: bool) -> None:
    random = np.random.default_rng(seed)
    points, areas = bent(0.7)
    moved = points @ Rotation.random(rng=random).as_matrix().T + random.normal(0.0, 50.0, 3)
    if mirrored:
        moved = moved * [-1.0, 1.0, 1.0]
    assert posture_distance(posture(points, areas), posture(moved, areas)) < 0.01


def test_another_mesh_of_the_same_surface_is_nearly_the_same() -> None:
    assert posture_distance(posture(*ball(3, 40.0)), posture(*ball(4, 40.0))) < 0.5


def test_the_further_it_bends_the_further_it_is() -> None:
    straight = posture(*bent(0.0))
    distances = [posture_distance(straight, posture(*bent(angle))) for angle in (0.3, 0.8, 1.5, 2.5)]
    assert distances == sorted(distances)
    assert distances[0] > 0.3


def test_a_distance_is_the_mean_step_between_distributions() -> None:
    near, far = np.ones(STEPS, np.float32), np.ones(STEPS, np.float32)
    near[:10], far[:17] = 0.0, 0.0
    assert posture_distance(near, far) == posture_distance(far, near) == pytest.approx(7.0 * STEP)


def test_a_single_point_has_a_posture() -> None:
    found = posture(np.zeros((1, 3)), np.ones(1))
    assert np.isfinite(found).all()
    assert found[-1] == 1.0
