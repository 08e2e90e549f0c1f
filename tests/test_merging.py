from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from index.arrays import RowArray
from index.distances import levels_of
from index.layout import Layout
from index.merging import Merges, learn_merges, merged
from tests.layouts import byte_layout, clustered_rows, random_rows, single_layout

seeds = st.integers(0, 2**32 - 1)


@st.composite
def learnt(draw: st.DrawFn) -> tuple[Layout, RowArray, Merges]:
    """Draw rows of which some, or all, are the same, and merges learnt from them."""
    make = draw(st.sampled_from([byte_layout, single_layout]))
    lengths = draw(st.lists(st.integers(1, 8), min_size=1, max_size=3))
    layout = make(draw(st.sampled_from([1, 2])), lengths)
    seed = draw(seeds)
    different = random_rows(layout, draw(st.integers(1, 12)), seed)
    chosen = np.random.default_rng(seed).integers(0, len(different), draw(st.integers(1, 100)))
    n_groups = draw(st.integers(len(lengths), layout.width))
    return layout, different, learn_merges(different[chosen], layout, n_groups)


def block_gaps(gaps: RowArray, layout: Layout) -> list[float]:
    return [float(np.abs(gaps[start:end]).sum()) for start, end in pairwise(layout.edges.tolist())]


def near_share(layout: Layout, rows: RowArray, n_groups: int) -> float:
    """Return the share of the distances to the nearest of some rows that sums over groups keep."""
    sums = merged(rows, layout, learn_merges(rows, layout, n_groups))
    levels = levels_of(rows, layout)
    kept = []
    for place in range(0, len(rows), len(rows) // 20):
        gaps = np.abs(levels - levels[place]).sum(axis=1)
        near = np.argsort(gaps)[1:6]
        kept.append(np.abs(sums[near] - sums[place]).sum() / gaps[near].sum())
    return float(np.mean(kept))


@given(learnt=learnt(), seed=seeds)
def test_signed_sums_never_exceed_the_distance_of_their_block(
    learnt: tuple[Layout, RowArray, Merges], seed: int
) -> None:
    layout, rows, merges = learnt
    rows = np.vstack([rows, random_rows(layout, 3, seed)])  # others than were learnt from too
    levels, sums = levels_of(rows, layout), merged(rows, layout, merges)
    for place in range(len(rows)):
        gaps = block_gaps(levels[place] - levels[0], layout)
        rounding = 1e-14 * np.abs(levels).sum(axis=1).max()  # of the sums; of bytes there is none
        for block, gap in enumerate(gaps):
            mine = np.abs(sums[place] - sums[0])[merges.blocks == block].sum()
            assert mine <= gap + (0.0 if layout.packings else rounding)


@given(learnt=learnt())
def test_each_group_lies_in_one_block_and_each_number_in_one_group(
    learnt: tuple[Layout, RowArray, Merges],
) -> None:
    layout, _, merges = learnt
    assert merges.groups.shape == merges.signs.shape == (layout.width,)
    assert set(np.abs(merges.signs)) == {1.0}
    assert merges.groups.min() >= 0
    assert merges.groups.max() < merges.count
    of_numbers = np.repeat(np.arange(len(layout.lengths)), layout.lengths)
    np.testing.assert_array_equal(merges.blocks[merges.groups], of_numbers)


@given(learnt=learnt(), seed=seeds)
def test_sums_are_those_of_the_numbers_in_each_group(
    learnt: tuple[Layout, RowArray, Merges], seed: int
) -> None:
    layout, rows, merges = learnt
    signed = levels_of(rows, layout) * merges.signs
    sums = np.stack([signed[:, merges.groups == g].sum(axis=1) for g in range(merges.count)], axis=1)
    np.testing.assert_allclose(merged(rows, layout, merges), sums, rtol=0, atol=1e-9)
    order = np.random.default_rng(seed).permutation(merges.count)
    np.testing.assert_allclose(merged(rows, layout, merges.ordered(order)), sums[:, order], rtol=0, atol=1e-9)


@pytest.mark.parametrize(
    "layout", [byte_layout(1, (20, 60, 40)), single_layout(1, (60, 60), (1.0, 1.0)), single_layout(2, (120,))]
)
def test_few_groups_keep_most_of_a_near_distance_where_numbers_move_together(layout: Layout) -> None:
    assert near_share(layout, clustered_rows(layout, 800, 5), 24) > 0.75


def test_opposite_numbers_are_merged_with_opposite_signs() -> None:
    layout = single_layout(1, (4,), (1.0,))
    amounts = np.random.default_rng(0).normal(size=(200, 2))
    rows = np.stack([amounts[:, 0], amounts[:, 1], -amounts[:, 0], -3 * amounts[:, 1]], axis=1)
    merges = learn_merges(rows.astype(np.float32), layout, 2)
    assert merges.groups[0] == merges.groups[2] != merges.groups[1] == merges.groups[3]
    assert merges.signs[0] == -merges.signs[2]
    assert merges.signs[1] == -merges.signs[3]


def test_the_same_rows_give_the_same_merges() -> None:
    layout = byte_layout(1, (20, 60, 40))
    rows = clustered_rows(layout, 300, 4)
    one, other = (learn_merges(rows, layout, 16) for _ in range(2))
    np.testing.assert_array_equal(one.groups, other.groups)
    np.testing.assert_array_equal(one.signs, other.signs)
