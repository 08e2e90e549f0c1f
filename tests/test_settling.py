"""After settling, no square of grid points is checkered."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from service.samples.settling import settle
from worker.arrays import BoolArray


def _checkered(inside: BoolArray) -> int:
    count = 0
    for axis in range(3):
        turned = np.moveaxis(inside, axis, 0)
        a, b, c, d = turned[:, :-1, :-1], turned[:, 1:, :-1], turned[:, 1:, 1:], turned[:, :-1, 1:]
        count += int(((a == c) & (b == d) & (a != b)).sum())
    return count


@given(seed=st.integers(0, 10_000))
@settings(max_examples=30)
def test_single_flaws_are_mended_and_sizes_kept(seed: int) -> None:
    generator = np.random.default_rng(seed)
    x, y, z = np.meshgrid(*[np.linspace(-2, 2, 9)] * 3, indexing="ij")
    values = np.sqrt(x**2 + y**2 + z**2) - 1.3 + 0.05 * generator.normal(size=x.shape)
    settled = settle(values)
    assert _checkered(settled < 0) == 0
    np.testing.assert_array_equal(np.abs(settled), np.abs(values))


def test_a_clean_field_stays_as_it_is() -> None:
    x = np.linspace(-1, 1, 6)
    values = x[:, None, None] + 0 * x[:, None] + 0 * x
    np.testing.assert_array_equal(settle(values), values)


def test_the_corner_nearest_to_the_surface_changes_sides() -> None:
    values = np.ones((3, 3, 3))
    values[1, 1, 1], values[1, 2, 2] = -1.0, -0.1
    assert _checkered(values < 0) > 0
    settled = settle(values)
    assert settled[1, 2, 2] == 0.1
    assert settled[1, 1, 1] == -1.0
