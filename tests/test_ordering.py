import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from index.arrays import ByteArray, PositionArray
from index.ordering import by_halves

seeds = st.integers(0, 2**32 - 1)


def make_codes(seed: int, n_rows: int, n_groups: int) -> ByteArray:
    generator = np.random.default_rng(seed)
    most = int(generator.choice([1, 3, 256]))
    return generator.integers(0, most, (n_rows, n_groups), dtype=np.uint8)


def spread(codes: ByteArray, order: PositionArray, box: int) -> float:
    """Sum, over boxes and groups, of the greatest less the least code."""
    boxes = (codes[order[start : start + box]] for start in range(0, len(codes), box))
    return float(sum(np.ptp(rows, axis=0).astype(int).sum() for rows in boxes))


@given(seed=seeds, n_rows=st.integers(0, 200), n_groups=st.integers(1, 6), box=st.integers(1, 20))
def test_every_row_has_one_place(seed: int, n_rows: int, n_groups: int, box: int) -> None:
    order = by_halves(make_codes(seed, n_rows, n_groups), np.ones(n_groups), box)
    np.testing.assert_array_equal(np.sort(order), np.arange(n_rows))


@given(seed=seeds, n_rows=st.integers(1, 300), box=st.integers(1, 9))
def test_one_group_is_sorted_and_equal_keys_keep_their_order(seed: int, n_rows: int, box: int) -> None:
    """As halves are sorted stably, so is the whole, but where one box holds it all."""
    keys = make_codes(seed, n_rows, 1)
    codes = np.hstack([np.zeros_like(keys), keys, np.full_like(keys, 7)])
    expected = np.argsort(keys[:, 0], kind="stable") if n_rows > box else np.arange(n_rows)
    np.testing.assert_array_equal(by_halves(codes, np.ones(3), box), expected)


def test_boxes_are_much_smaller_than_in_random_order() -> None:
    generator = np.random.default_rng(0)
    middles = generator.integers(0, 256, (40, 8))
    rows = middles[generator.integers(0, 40, 4000)] + generator.normal(0, 4, (4000, 8))
    codes = rows.clip(0, 255).astype(np.uint8)
    order = by_halves(codes, np.ones(8), 32)
    assert spread(codes, order, 32) < 0.4 * spread(codes, generator.permutation(4000), 32)


def test_groups_that_count_more_are_halved_more_often() -> None:
    codes = np.random.default_rng(0).integers(0, 256, (2048, 2), dtype=np.uint8)
    order = by_halves(codes, np.array([1.0, 8.0]), 64)
    first, second = (spread(codes[:, [group]], order, 64) for group in (0, 1))
    assert second < first / 4
