import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.test_registration import trimmed
from worker.descriptors.trimming import trimmed_mean

TENTH, HALVES = np.full(10, 0.1, np.float32), np.array([0.5, 0.5], np.float32)
KEPT = 0.9


def test_the_worst_tenth_of_the_area_does_not_count() -> None:
    assert trimmed_mean(np.arange(1.0, 11.0, dtype=np.float32), TENTH, KEPT) == pytest.approx(5.0)
    two = np.array([3.0, 1.0], np.float32)
    assert trimmed_mean(two, HALVES, KEPT) == pytest.approx((0.5 + 0.4 * 3.0) / 0.9)
    assert trimmed_mean(two, np.array([0.1, 0.9], np.float32), KEPT) == pytest.approx(1.0)


@given(st.integers(0, 1000), st.integers(1, 60), st.floats(0.1, 10.0), st.booleans())
def test_it_is_the_integral_of_the_quantiles(seed: int, size: int, scale: float, ties: bool) -> None:
    random = np.random.default_rng(seed)
    values = random.exponential(1.0, size).astype(np.float32)
    if ties:
        values = np.ceil(3 * values)
    shares = random.uniform(0.01, 1.0, size).astype(np.float32)
    before = values.copy(), shares.copy()
    assert trimmed_mean(values, np.float32(scale) * shares, KEPT) == pytest.approx(
        trimmed(values, shares), rel=1e-5
    )
    np.testing.assert_array_equal((values, shares), before)
    assert trimmed_mean(values, shares, 1.0) == pytest.approx(np.average(values, weights=shares), rel=1e-5)


def test_it_comes_to_an_end_whatever_the_numbers() -> None:
    shares = np.full(5, 0.2, np.float32)
    assert trimmed_mean(np.array([1.0, np.inf, 2.0, 4.0, 0.5], np.float32), shares, KEPT) == np.inf
    trimmed_mean(np.array([1.0, np.nan, 2.0, np.nan, 0.5], np.float32), shares, KEPT)
    assert trimmed_mean(np.ones(5, np.float32), 0 * shares + np.float32(1e-30), KEPT) == pytest.approx(1.0)
