from typing import Any

import numpy as np
import numpy.typing as npt
from hypothesis import given
from hypothesis import strategies as st

from index.arrays import ByteArray, DoubleArray, PositionArray, SingleArray
from index.bounds import Question, box_bounds, fine_bounds, least_bounds, rows_within

SIZE = 4  # rows in a box
seeds = st.integers(0, 2**32 - 1)


class Case:
    """Random codes, and a query; weights are such that single precision holds every sum."""

    def __init__(self, seed: int) -> None:
        generator = np.random.default_rng(seed)
        self.power = int(generator.choice([1, 2]))
        n_boxes, groups = generator.integers(1, 9), int(generator.integers(1, 30))
        most = 255 if self.power == 1 else 20
        self.codes: ByteArray = generator.integers(0, most + 1, (n_boxes, groups, SIZE), dtype=np.uint8)
        ends = generator.integers(0, most + 1, (2, groups), dtype=np.uint8)
        self.below, self.above = np.sort(ends, axis=0)
        self.below[::3] = self.above[::3]
        blocks = generator.integers(0, 3, groups)
        self.blocks: PositionArray = np.sort(blocks) if self.power == 2 else blocks
        of_blocks = generator.choice([0.0, 0.25, 1.0, 3.0], 3).astype(np.float32)
        self.weights: SingleArray = of_blocks[self.blocks]
        self.question = Question.of(self.below, self.above, self.blocks, self.weights, self.power)

    def slow(self, away: npt.NDArray[Any]) -> DoubleArray:
        """Return Σ_b w_b (Σ_g steps)^p of steps (g, ...)."""
        total = np.zeros(away.shape[1:])
        for block in np.unique(self.blocks):
            mine = self.blocks == block
            total += float(self.weights[mine][0]) * away[mine].sum(axis=0, dtype=float) ** self.power
        return total

    def away(self, low: npt.NDArray[Any], high: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Return how far intervals of codes (g, ...) are from the query's."""
        ends = (end[: len(low)].astype(int) for end in (self.below, self.above))
        below, above = (end.reshape(-1, *[1] * (low.ndim - 1)) for end in ends)
        return np.asarray(np.maximum(np.maximum(low.astype(int) - above, below - high.astype(int)), 0))

    def rows(self) -> DoubleArray:
        """Return the bound of each row by the slow formula, (n, r)."""
        codes = self.codes.transpose(1, 0, 2)
        return self.slow(self.away(codes, codes))


@given(seed=seeds)
def test_boxes_are_bounded_by_the_formula(seed: int) -> None:
    case = Case(seed)
    lows, highs = (np.ascontiguousarray(end(case.codes, axis=2).T) for end in (np.min, np.max))
    bounds = np.empty(len(case.codes), np.float32)
    box_bounds(lows, highs, case.question, bounds)
    np.testing.assert_array_equal(bounds, case.slow(case.away(lows, highs)))
    assert (bounds <= case.rows().min(axis=1)).all()


@given(seed=seeds)
def test_the_least_bound_of_a_box_holds_for_all_of_its_rows(seed: int) -> None:
    case = Case(seed)
    boxes = np.random.default_rng(seed).permutation(len(case.codes))[:5]
    expected = case.rows()[boxes].min(axis=1)
    least = np.empty(len(boxes), np.float32)
    least_bounds(case.codes, boxes, case.question, least)
    assert (least <= expected).all()
    if len(set(case.blocks)) == 1:  # then nothing is lost by bounding block by block
        np.testing.assert_array_equal(least, expected)


@given(seed=seeds)
def test_single_rows_are_bounded_by_the_same_formula(seed: int) -> None:
    case = Case(seed)
    codes = np.ascontiguousarray(case.codes.transpose(0, 2, 1)).reshape(-1, case.codes.shape[1])
    rows = np.random.default_rng(seed).permutation(len(codes))[:7]
    bounds = np.empty(len(rows), np.float32)
    fine_bounds(codes, rows, case.question, bounds)
    np.testing.assert_array_equal(bounds, case.rows().reshape(-1)[rows])


@given(seed=seeds, data=st.data())
def test_exactly_the_rows_within_the_limit_are_collected_in_order(seed: int, data: st.DataObject) -> None:
    case = Case(seed)
    expected = case.rows().reshape(-1)
    boxes = np.flatnonzero(np.random.default_rng(seed).random(len(case.codes)) < 0.7)
    limit = data.draw(st.sampled_from([*expected.tolist(), 0.0, np.inf]))  # equal ones are within
    positions = np.empty(len(boxes) * SIZE, np.int64)
    found = rows_within(case.codes, boxes, case.question, limit, positions)
    rows = [box * SIZE + r for box in boxes.tolist() for r in range(SIZE)]
    assert positions[:found].tolist() == [row for row in rows if expected[row] <= limit]


def test_sums_beyond_sixteen_bits_never_give_more_than_the_distance() -> None:
    groups = 400
    zeros, full = np.zeros(groups, np.uint8), np.full((groups, 1), 255, np.uint8)
    blocks, weights = np.zeros(groups, np.int64), np.ones(groups, np.float32)
    bounds = np.empty(1, np.float32)
    box_bounds(full, full, Question.of(zeros, zeros, blocks, weights, 1), bounds)
    assert bounds[0] <= 400 * 255


def test_a_sum_ends_where_the_next_is_weighed_otherwise_or_squared_apart() -> None:
    blocks, ends = np.array([0, 0, 1, 2]), np.zeros(4, np.uint8)
    weights = np.array([1.0, 1.0, 1.0, 2.0], np.float32)
    of_sums, of_squares = (Question.of(ends, ends, blocks, weights, power).ends.tolist() for power in (1, 2))
    assert of_sums == [False, False, True, True]
    assert of_squares == [False, True, True, True]
