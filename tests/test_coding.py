from fractions import Fraction

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st

from index import coding as coding_module
from index.arrays import RowArray
from index.coding import Coding
from index.distances import levels_of
from index.layout import Layout
from index.merging import Merges, learn_merges, merged
from tests.layouts import byte_layout, clustered_rows, random_rows, single_layout

seeds = st.integers(0, 2**32 - 1)


def steps_away(coding: Coding, rows: RowArray, query: RowArray) -> npt.NDArray[np.int64]:
    """Return how many steps codes and ends promise at least, (m, g)."""
    largest = float(np.abs(levels_of(rows, coding.layout)).sum(axis=1).max())
    below, above = (end.astype(int) for end in coding.ends(query, largest))
    codes = coding.codes(rows).astype(int)
    return np.asarray(np.maximum(np.maximum(codes - above, below - codes), 0))


def exact_sums(coding: Coding, row: RowArray) -> list[Fraction]:
    sums = [Fraction(0)] * coding.merges.count
    levels = levels_of(row[None], coding.layout)[0].tolist()
    for level, group, sign in zip(levels, coding.merges.groups, coding.merges.signs, strict=True):
        sums[group] += Fraction(level) * int(sign)
    return sums


def check_bounds(coding: Coding, rows: RowArray, query: RowArray) -> None:
    wanted = exact_sums(coding, query)
    for row, away in zip(rows, steps_away(coding, rows, query).tolist(), strict=True):
        for mine, other, step, least in zip(exact_sums(coding, row), wanted, coding.steps, away, strict=True):
            assert least * Fraction(float(step)) <= abs(mine - other)


@given(
    seed=seeds,
    layout=st.sampled_from(
        [make(power, (4, 9, 3)) for make in (byte_layout, single_layout) for power in (1, 2)]
    ),
)
def test_no_row_is_nearer_than_its_code_says(seed: int, layout: Layout) -> None:
    known = random_rows(layout, 60, seed)
    beyond = random_rows(layout, 5, seed + 1) * (1 if layout.packings else np.float32(50))
    coding = Coding.learn(known, layout, 7)
    for query in (known[0], beyond[0]):
        check_bounds(coding, np.vstack([known[:10], beyond]), query)


@given(
    seed=seeds,
    offset=st.sampled_from([0.0, 1e-30, 1.0, 1e7, 1e30]),
    spread=st.sampled_from([1e-7, 1e-3, 1.0]),
    step=st.sampled_from([1e-300, 1e-20, 1e-6, 1.0, 1e10]),
)
def test_that_holds_for_huge_offsets_and_tiny_steps(
    seed: int, offset: float, spread: float, step: float
) -> None:
    layout = single_layout(1, (5, 7))
    numbers = np.random.default_rng(seed).uniform(-1, 1, (12, layout.width))
    rows = (offset * (1 + spread * numbers)).astype(np.float32)
    merges = learn_merges(rows, layout, 4)
    steps = np.full(4, step * max(offset, 1.0))
    coding = Coding(layout=layout, merges=merges, origins=merged(rows[:1], layout, merges)[0], steps=steps)
    check_bounds(coding, rows, rows[1])
    check_bounds(Coding.learn(rows, layout, 4), rows, rows[1])


def test_a_bound_falls_short_by_less_than_three_steps_within_the_range() -> None:
    layout = byte_layout(1, (10, 30, 20))
    rows = random_rows(layout, 400)
    coding = Coding.learn(rows, layout, 60)
    places = coding.places(rows)
    inside = ((places >= 2) & (places < 254)).all(axis=0)  # groups narrower than the codes' range
    assert inside.any()
    away = steps_away(coding, rows, rows[0])
    assert (np.abs(places - places[0]) - away)[:, inside].max() < 3


@pytest.mark.parametrize("power", [1, 2])
def test_groups_that_are_added_up_have_steps_that_count_the_same(power: int) -> None:
    layout = single_layout(power, (20, 20, 20))
    coding = Coding.learn(clustered_rows(layout, 500, 4), layout, 24)
    blocks = coding.merges.blocks
    if power == 1:
        np.testing.assert_allclose(coding.counts, 1.0, rtol=1e-12)
    else:
        assert (np.diff(blocks) >= 0).all()  # block by block, as each is squared apart
        for block in range(3):
            np.testing.assert_allclose(np.ptp(coding.steps[blocks == block]), 0, atol=1e-12)


def test_the_rounding_of_sums_is_allowed_for_where_steps_are_finer() -> None:
    """The same numbers in another order have the same sum, but not the same rounding of it."""
    layout = single_layout(1, (30,), (1.0,))
    generator = np.random.default_rng(0)
    numbers = (10.0 ** generator.uniform(-20, 1, 30)).astype(np.float32)
    rows = np.stack([generator.permutation(numbers) for _ in range(40)])
    merges = Merges(groups=np.zeros(30, np.int64), signs=np.ones(30), blocks=np.zeros(1, np.int64))
    middle = float(merged(rows[:1], layout, merges)[0, 0])
    step = 1e-17 * middle
    coding = Coding(
        layout=layout, merges=merges, origins=np.array([middle - 128 * step]), steps=np.array([step])
    )
    assert np.ptp(coding.codes(rows)) > 0
    check_bounds(coding, rows, rows[0])


def test_a_coding_comes_back_from_its_arrays() -> None:
    layout = single_layout(2, (5, 9))
    rows = random_rows(layout, 100)
    coding = Coding.learn(rows, layout, 6)
    again = Coding.restored(layout, coding.arrays("a") | Coding.learn(rows, layout, 3).arrays("b"), "a")
    np.testing.assert_array_equal(again.places(rows), coding.places(rows))
    np.testing.assert_array_equal(again.merges.blocks, coding.merges.blocks)


@pytest.mark.parametrize("scale", [0.0, 1e-42, 1.0, 3e38])
@pytest.mark.parametrize("power", [1, 2])
def test_rows_that_are_all_the_same_can_be_coded(power: int, scale: float) -> None:
    layout = single_layout(power, (3, 4))
    rows = np.full((50, 7), scale, np.float32)
    coding = Coding.learn(rows, layout, 4)
    assert (coding.steps > 0).all()
    assert np.isfinite(coding.origins).all()
    assert coding.counts.max() == 1.0  # which single precision holds, whatever the size of the numbers
    assert steps_away(coding, rows, rows[0]).max() == 0


def test_codes_do_not_depend_on_the_pieces(monkeypatch: pytest.MonkeyPatch) -> None:
    layout = byte_layout(1, (10, 30, 20))
    rows = random_rows(layout, 100)
    coding = Coding.learn(rows, layout, 24)
    whole = coding.codes(rows)
    monkeypatch.setattr(coding_module, "PIECE", 7)
    np.testing.assert_array_equal(coding.codes(rows), whole)
