import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from worker.descriptors.diffusion import (
    ROWS,
    diffusion_distances,
    distance_quantiles,
    distribution_on_grid,
    joint_distances,
)


def spectrum(seed: int, n_points: int = 40) -> tuple[np.ndarray, np.ndarray]:
    random = np.random.default_rng(seed)
    values = np.sort(np.r_[0.0, random.uniform(0, 5e-3, 9)])
    functions = random.standard_normal((n_points, 10))
    functions[:, 0] = 1.0
    return values, functions


@given(st.integers(0, 2**32 - 1), st.sampled_from([1024.0, 4096.0]))
def test_distances_are_the_sum_over_pairs_that_defines_them(seed: int, time: float) -> None:
    values, functions = spectrum(seed)
    squares = sum(
        np.exp(-2 * value * time) * (f[:, None] - f) ** 2
        for value, f in zip(values[1:], functions.T[1:], strict=True)
    )
    found = diffusion_distances(values, functions, time)
    np.testing.assert_allclose(found, np.sqrt(squares), atol=1e-3 * float(np.sqrt(squares).max()))


def test_distances_are_a_metric() -> None:
    distances = diffusion_distances(*spectrum(1), 1024.0).astype(float)
    np.testing.assert_array_equal(distances, distances.T)
    np.testing.assert_array_equal(np.diag(distances), 0.0)
    through = distances[:, :, None] + distances[None]
    assert (distances[:, None, :] <= through + 1e-5 * distances.max()).all()


def test_joint_distances_are_means_of_products() -> None:
    one, two, times = spectrum(1), spectrum(2), (1024.0, 4096.0)
    expected = np.mean([diffusion_distances(*one, t) * diffusion_distances(*two, t) for t in times], axis=0)
    np.testing.assert_allclose(joint_distances([one, two], times), expected, rtol=1e-5)


def test_quantiles_of_equal_areas_are_those_of_all_pairs() -> None:
    distances = diffusion_distances(*spectrum(3, 200), 1024.0)
    found = distance_quantiles(distances, np.ones(200), 64)
    expected = np.quantile(distances, (np.arange(64) + 0.5) / 64)
    np.testing.assert_allclose(found, expected, atol=2e-3 * float(distances.max()))


def test_a_sample_of_twice_the_area_counts_as_two() -> None:
    distances = diffusion_distances(*spectrum(4, 50), 1024.0)
    twice = np.r_[np.arange(50), 0]
    weighted = distance_quantiles(distances, np.r_[2.0, np.ones(49)], 32)
    np.testing.assert_allclose(distance_quantiles(distances[np.ix_(twice, twice)], np.ones(51), 32), weighted)


@pytest.mark.parametrize("n_levels", [256, 1024])
def test_a_distribution_is_read_back_on_any_grid(n_levels: int) -> None:
    levels = (np.arange(n_levels) + 0.5) / n_levels
    quantiles = np.sqrt(levels)  # F(d) = d²
    grid = np.linspace(0.05, 1.5, 30)
    expected = np.minimum(grid, 1.0) ** 2
    np.testing.assert_allclose(distribution_on_grid(quantiles, grid) * 30, expected, atol=1 / n_levels)


def test_blocks_join_without_a_seam() -> None:
    values, functions = spectrum(5, 2 * ROWS + 7)
    found = diffusion_distances(values, functions, 1024.0)
    points = functions * np.exp(-values * 1024.0)
    expected = np.linalg.norm(points[:, None] - points, axis=2)
    np.testing.assert_allclose(found, expected, atol=1e-3 * float(expected.max()))
    np.testing.assert_array_equal(found, found.T)


def test_quantiles_weigh_each_pair_by_both_areas() -> None:
    distances = diffusion_distances(*spectrum(6, 2 * ROWS + 7), 1024.0)
    areas = np.random.default_rng(6).uniform(0.1, 1.0, len(distances))
    order = np.argsort(distances, axis=None)
    cumulative = np.cumsum(np.outer(areas, areas).ravel()[order]) / areas.sum() ** 2
    expected = np.interp((np.arange(64) + 0.5) / 64, cumulative, distances.ravel()[order])
    found = distance_quantiles(distances, areas, 64)
    np.testing.assert_allclose(found, expected, atol=1e-4 * float(distances.max()))


def test_a_shape_of_one_point_has_only_distance_0() -> None:
    quantiles = distance_quantiles(np.zeros((1, 1), np.float32), np.ones(1), 8)
    np.testing.assert_array_equal(quantiles, 0.0)
    np.testing.assert_array_equal(distribution_on_grid(quantiles, np.array([0.5, 1.0])) * 2, 1.0)
