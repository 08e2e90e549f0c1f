import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from index.packing import PACKINGS, rounded
from worker.descriptors.curves import whiten_curves

CODES = np.arange(256, dtype=np.uint8)
SHARES = ("log-hks", "colour-histogram")


@pytest.mark.parametrize("name", PACKINGS)
def test_every_byte_stands_for_a_number_of_its_own(name: str) -> None:
    packing = PACKINGS[name]
    numbers = packing.unpack(CODES)
    assert (np.diff(numbers) > 0).all()
    np.testing.assert_array_equal(packing.pack(numbers), CODES)


@pytest.mark.parametrize("name", PACKINGS)
def test_numbers_beyond_the_range_count_as_its_ends(name: str) -> None:
    ends = PACKINGS[name].unpack(CODES[[0, -1]])
    np.testing.assert_array_equal(rounded(name, np.array([-1e30, 1e30], np.float32)), ends)


@pytest.mark.parametrize("name", SHARES)
@given(share=st.floats(0, 1, width=32))
def test_a_share_is_kept_to_half_a_step_of_its_root(name: str, share: float) -> None:
    kept = float(rounded(name, np.array([share], np.float32))[0])
    assert abs(np.sqrt(kept) - np.sqrt(share)) <= 0.5 / 255 + 1e-6


@pytest.mark.parametrize("name", SHARES)
def test_nothing_and_everything_are_kept_exactly(name: str) -> None:
    np.testing.assert_array_equal(rounded(name, np.array([0, 1], np.float32)), [0, 1])


@given(seed=st.integers(0, 2**32 - 1), colour=st.integers(0, 2), power=st.floats(1, 30))
def test_whitened_curves_are_kept_to_half_a_step(seed: int, colour: int, power: float) -> None:
    curves = np.random.default_rng(seed).random((3, 16, 3))
    curves[..., colour] **= power  # few bins hold nearly all of it
    whitened = whiten_curves(100 * curves).astype(np.float32)
    assert np.abs(rounded("colour-curves", whitened) - whitened).max() <= 0.5 / 13 + 1e-6


@pytest.mark.parametrize("colour", [0, 1, 2])
def test_the_sharpest_curve_is_within_the_range(colour: int) -> None:
    curves = np.zeros((3, 16, 3))
    curves[1, 5, colour] = 100.0
    whitened = whiten_curves(curves).astype(np.float32)
    assert np.abs(rounded("colour-curves", whitened) - whitened).max() <= 0.5 / 13 + 1e-6


def test_other_blocks_stay_as_they_are() -> None:
    block = np.array([0.1, -3.0, 1e20], np.float32)
    np.testing.assert_array_equal(rounded("hks-0", block), block)
