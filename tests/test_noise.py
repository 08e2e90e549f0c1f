"""Noise is smooth, bounded and the same for the same seed."""

import numpy as np

from service.samples.noise import cell_distances, layered_noise, smooth_noise

POINTS = np.random.default_rng(3).uniform(-20, 20, (2000, 3))


def test_the_same_seed_gives_the_same_noise() -> None:
    first = layered_noise(POINTS, np.random.default_rng(1))
    np.testing.assert_array_equal(first, layered_noise(POINTS, np.random.default_rng(1)))
    assert np.abs(first - layered_noise(POINTS, np.random.default_rng(2))).max() > 0.1


def test_noise_is_bounded_and_smooth() -> None:
    values = smooth_noise(POINTS, np.random.default_rng(1))
    assert np.abs(values).max() <= 1
    near = smooth_noise(POINTS + 1e-6, np.random.default_rng(1))
    np.testing.assert_allclose(values, near, atol=1e-4)


def test_the_second_seed_is_farther_than_the_first() -> None:
    distances = cell_distances(POINTS, np.random.default_rng(1))
    assert (distances[:, 0] <= distances[:, 1]).all()
    assert distances[:, 0].max() < 2
