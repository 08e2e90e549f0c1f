import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from worker.descriptors.curves import colour_curves, whiten_curves


def test_the_mean_over_a_curve_is_the_mean_over_the_surface() -> None:
    random = np.random.default_rng(0)
    lab, areas = random.uniform(0, 100, (500, 3)), random.uniform(0.1, 3.0, 500)
    curves = colour_curves(random.standard_normal((500, 3)), lab, areas, 16)
    assert curves.shape == (3, 16, 3)
    np.testing.assert_allclose(curves.mean(axis=1), np.tile(areas @ lab / areas.sum(), (3, 1)))


def test_a_colour_that_rises_along_the_order_gives_a_straight_curve() -> None:
    order = np.random.default_rng(0).permutation(1600).astype(float)
    lab = np.column_stack([order, -order, 0 * order])
    curve = colour_curves(order[:, None], lab, np.ones(1600), 16)[0]
    np.testing.assert_allclose(curve[:, 0], np.arange(16) * 100 + 49.5)


def test_a_vertex_across_a_border_counts_in_both_bins_by_its_parts() -> None:
    lab = np.array([[10.0, 0, 0], [40.0, 0, 0]])
    curve = colour_curves(np.array([[0.0], [1.0]]), lab, np.array([3.0, 1.0]), 2)[0]
    np.testing.assert_allclose(curve[:, 0], [10.0, 25.0])


@given(st.floats(0.4, 2.5), st.floats(-30, 30), st.floats(0.4, 2.5), st.floats(-20, 20))
def test_contrast_brightness_and_saturation_cancel(
    contrast: float, brightness: float, gain: float, shift: float
) -> None:
    curves = np.random.default_rng(0).uniform(-50, 50, (3, 16, 3))
    changed = curves * [contrast, gain, gain] + [brightness, shift, -shift]
    np.testing.assert_allclose(whiten_curves(changed), whiten_curves(curves), atol=1e-9)


def test_a_single_colour_gives_zeros() -> None:
    np.testing.assert_allclose(whiten_curves(np.full((3, 16, 3), 42.0)), 0.0, atol=1e-12)
