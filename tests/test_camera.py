"""The frame holds the whole shape, the right way up."""

import numpy as np
import pytest

from worker.pictures.camera import camera_axes, look_at

CUBE = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=np.float64)


def test_camera_axes_are_orthonormal_and_right_handed() -> None:
    axes = camera_axes()
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(axes) == pytest.approx(1.0)


@pytest.mark.parametrize("move", [0.0, 1e6])
@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e4])
def test_everything_is_inside_the_frame_and_fills_it(scale: float, move: float) -> None:
    pixels = look_at(scale * CUBE + move * scale, 100).pixels
    assert pixels.min() >= 0
    assert pixels.max() <= 100
    assert np.ptp(pixels, axis=0).max() > 90


def test_what_is_higher_up_is_shown_higher_up() -> None:
    view = look_at(np.array([(0.0, 0.0, 0.0), (0.0, 1.0, 0.0)]), 100)
    assert view.pixels[1, 1] < view.pixels[0, 1]


def test_what_is_in_front_is_nearer() -> None:
    view = look_at(np.array([(0.0, 0.0, 0.0), (0.0, 0.0, 1.0)]), 100)
    assert view.depths[1] < view.depths[0]


def test_a_single_place_does_not_divide_by_zero() -> None:
    assert np.isfinite(look_at(np.zeros((3, 3)), 10).pixels).all()
