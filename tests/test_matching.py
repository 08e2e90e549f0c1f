import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.distance import cdist

from worker.arrays import SingleArray
from worker.descriptors.matching import (
    FAINTEST,
    match_backwards,
    match_jointly,
    match_rates,
    soft_colours,
)

SOFTNESS = 0.5


def made(seed: int, rows: int, columns: int) -> SingleArray:
    return np.random.default_rng(seed).normal(size=(rows, columns)).astype(np.float32)


def compared(seed: int, n_own: int, n_others: int) -> tuple[SingleArray, SingleArray]:
    """Return squared distances (n, p) by rates, and the least of each column."""
    squares, nearest = np.empty((n_others, n_own), np.float32), np.empty(n_own, np.float32)
    match_rates(made(seed, 6, n_own), made(seed + 1, 6, n_others), squares, nearest)
    return squares, nearest


SIZES = st.integers(1, 70)


@given(st.integers(0, 100), SIZES, SIZES)
def test_distances_by_rates_are_those_of_the_definition(seed: int, n_own: int, n_others: int) -> None:
    squares, nearest = compared(seed, n_own, n_others)
    expected = cdist(made(seed + 1, 6, n_others).T, made(seed, 6, n_own).T, "sqeuclidean")
    np.testing.assert_allclose(squares, expected, rtol=1e-5)
    np.testing.assert_array_equal(nearest, squares.min(axis=0))


@given(st.integers(0, 100), SIZES, SIZES)
def test_colours_add_to_them_both_ways(seed: int, n_own: int, n_others: int) -> None:
    squares, nearest = compared(seed, n_own, n_others)
    own, others = made(seed + 2, 3, n_own), made(seed + 3, 3, n_others)
    expected = squares + cdist(others.T, own.T, "sqeuclidean")  # (n, p)
    matches = np.full(n_own, -1, np.int32)
    match_jointly(squares, own, others, nearest, matches)
    np.testing.assert_allclose(nearest, expected.min(axis=0), rtol=1e-5)
    np.testing.assert_allclose(expected[matches, np.arange(n_own)], nearest, rtol=1e-5)
    np.testing.assert_allclose(match_backwards(squares, own, others), expected.min(axis=1), rtol=1e-5)


def test_of_equal_points_the_first_matches_and_nothing_is_left() -> None:
    point = made(0, 9, 1)
    points = np.repeat(point, 5, axis=1)
    squares, nearest, matches = np.ones((5, 5), np.float32), np.ones(5, np.float32), np.ones(5, np.int32)
    match_rates(points[:6], points[:6], squares, nearest)
    assert not nearest.any()
    match_jointly(squares, points[6:], points[6:], nearest, matches)
    assert not matches.any()
    assert not nearest.any()
    assert not match_backwards(squares, points[6:], points[6:]).any()


@given(st.integers(0, 100), SIZES, SIZES, st.floats(0.1, 30.0))
def test_soft_colours_are_means_by_the_exponential(
    seed: int, n_own: int, n_others: int, spread: float
) -> None:
    squares, nearest = compared(seed, n_own, n_others)
    squares, nearest = squares * np.float32(spread), nearest * np.float32(spread)
    lab = 30.0 * made(seed + 2, 3, n_others)
    shares = np.abs(made(seed + 3, 1, n_others)[0]) + np.float32(0.01)
    exponents = (nearest.astype(np.float64) - squares) / (2.0 * SOFTNESS**2)  # (n, p)
    weights = shares[:, None] * np.exp(np.maximum(exponents, FAINTEST))
    expected = lab @ (weights / weights.sum(axis=0))
    found = soft_colours(squares, nearest, SOFTNESS, lab, shares)
    np.testing.assert_allclose(found, expected, atol=2e-3)  # Lab units
