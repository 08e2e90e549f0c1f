import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from worker.descriptors.histograms import lab_histogram
from worker.geometry.colour import srgb_to_lab


@given(st.integers(0, 2**32 - 1))
def test_a_histogram_sums_to_1_whatever_the_colours(seed: int) -> None:
    srgb = np.random.default_rng(seed).choice([0.0, 0.3, 1.0], (50, 3))
    histogram = lab_histogram(srgb_to_lab(srgb), 16, 0.7)
    np.testing.assert_allclose(histogram.sum(), 1.0)
    assert (histogram >= 0).all()


def test_a_mixture_of_colours_is_the_mixture_of_histograms() -> None:
    red, blue = (
        np.tile(srgb_to_lab(np.array([colour])), (100, 1)) for colour in ([0.8, 0.3, 0.3], [0.3, 0.3, 0.7])
    )
    parts = [lab_histogram(lab, 16, 0.7) for lab in (red, blue)]
    mixed = lab_histogram(np.vstack([red, red, red, blue]), 16, 0.7)
    np.testing.assert_allclose(mixed, 0.75 * parts[0] + 0.25 * parts[1], atol=1e-3)


def test_distance_grows_with_the_difference_of_colours() -> None:
    base = np.tile([[50.0, 0.0, 0.0]], (100, 1))
    shifts = [0.0, 2.0, 5.0, 10.0, 30.0]
    distances = [
        np.abs(lab_histogram(base, 16, 0.7) - lab_histogram(base + [shift, 0, 0], 16, 0.7)).sum()
        for shift in shifts
    ]
    assert distances[0] == 0.0
    assert (np.diff(distances) > 0).all()
    np.testing.assert_allclose(distances[-1], 2.0, atol=0.1)  # nothing in common


def test_greys_do_not_jump_between_bins() -> None:
    grey = np.tile([[50.0, 1e-9, -1e-9]], (10, 1))
    np.testing.assert_allclose(
        lab_histogram(grey, 16, 0.7), lab_histogram(-grey * [-1, 1, 1], 16, 0.7), atol=1e-9
    )
