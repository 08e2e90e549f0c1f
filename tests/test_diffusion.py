import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from worker.arrays import FloatArray
from worker.descriptors.diffusion import ROWS, Spectrum, distance_quantiles, distribution_on_grid

TIMES = (1024.0, 4096.0)


def spectrum(seed: int, n_points: int = 40) -> Spectrum:
    random = np.random.default_rng(seed)
    values = np.sort(np.r_[0.0, random.uniform(0, 2e-3, 9)])
    functions = random.standard_normal((n_points, 10))
    functions[:, 0] = 1.0
    return values, functions


def distances_of(spectra: list[Spectrum], times: tuple[float, ...]) -> FloatArray:
    """Return the mean over times of the product over operators of the sums that define distances."""
    total = np.zeros((len(spectra[0][1]),) * 2)
    for time in times:
        product = np.ones_like(total)
        for values, functions in spectra:
            differences = functions[:, None] - functions[None]
            product *= np.sqrt((np.exp(-2 * values * time) * differences**2).sum(axis=2))
        total += product / len(times)
    return total


def quantiles_of(distances: FloatArray, areas: FloatArray, n_levels: int) -> FloatArray:
    """Sort all pairs and add up what they weigh."""
    order = np.argsort(distances, axis=None)
    cumulative = np.cumsum(np.outer(areas, areas).ravel()[order]) / areas.sum() ** 2
    levels = (np.arange(n_levels) + 0.5) / n_levels
    return distances.ravel()[order][np.searchsorted(cumulative, levels)]


@settings(max_examples=20)
@given(st.integers(0, 2**32 - 1), st.integers(1, 3), st.integers(2, 2 * ROWS + 7))
def test_quantiles_are_those_of_all_pairs_sorted(seed: int, n_operators: int, n_points: int) -> None:
    spectra = [spectrum(seed + k, n_points) for k in range(n_operators)]
    areas = np.random.default_rng(seed).uniform(0.1, 1.0, n_points)
    expected = quantiles_of(distances_of(spectra, TIMES), areas, 32)
    found = distance_quantiles(spectra, TIMES, areas, 32)
    np.testing.assert_allclose(found, expected, atol=1e-3 * float(expected.max()))


def test_the_distribution_differs_by_less_than_2e_5_from_that_of_all_pairs() -> None:
    spectra = [spectrum(3, 1500), spectrum(4, 1500)]
    areas = np.random.default_rng(3).uniform(0.5, 1.0, 1500)
    distances = distances_of(spectra, TIMES)
    order = np.argsort(distances, axis=None)
    cumulative = np.cumsum(np.outer(areas, areas).ravel()[order]) / areas.sum() ** 2
    found = distance_quantiles(spectra, TIMES, areas, 256)
    reached = cumulative[np.searchsorted(distances.ravel()[order], found) - 1]
    np.testing.assert_allclose(reached, (np.arange(256) + 0.5) / 256, atol=2e-5)


def test_functions_that_have_faded_change_nothing() -> None:
    values, functions = spectrum(5, 200)
    more = np.r_[values, 0.05], np.column_stack([functions, functions[:, 1]])
    areas = np.ones(200)
    found = distance_quantiles([more], TIMES, areas, 64)
    np.testing.assert_array_equal(found, distance_quantiles([(values, functions)], TIMES, areas, 64))


def test_a_sample_of_twice_the_area_counts_as_two() -> None:
    values, functions = spectrum(4, 50)
    weighted = distance_quantiles([(values, functions)], TIMES, np.r_[2.0, np.ones(49)], 32)
    twice = values, functions[np.r_[np.arange(50), 0]]
    found = distance_quantiles([twice], TIMES, np.ones(51), 32)
    np.testing.assert_allclose(found, weighted, atol=1e-3 * float(weighted.max()))


@pytest.mark.parametrize("n_levels", [256, 1024])
def test_a_distribution_is_read_back_on_any_grid(n_levels: int) -> None:
    levels = (np.arange(n_levels) + 0.5) / n_levels
    quantiles = np.sqrt(levels)  # F(d) = d²
    grid = np.linspace(0.05, 1.5, 30)
    expected = np.minimum(grid, 1.0) ** 2
    np.testing.assert_allclose(distribution_on_grid(quantiles, grid) * 30, expected, atol=1 / n_levels)


def test_a_shape_of_one_point_has_only_distance_0() -> None:
    quantiles = distance_quantiles([(np.zeros(1), np.ones((1, 1)))], TIMES, np.ones(1), 8)
    np.testing.assert_array_equal(quantiles, 0.0)
    np.testing.assert_array_equal(distribution_on_grid(quantiles, np.array([0.5, 1.0])) * 2, 1.0)


def test_the_same_spectrum_gives_the_same_bits() -> None:
    first, second = (distance_quantiles([spectrum(7, 300)], TIMES, np.ones(300), 64) for _ in range(2))
    assert first.tobytes() == second.tobytes()
