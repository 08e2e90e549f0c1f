from typing import Any

import numpy as np
import numpy.typing as npt
from hypothesis import given
from hypothesis import strategies as st

from index.arrays import ByteArray, DoubleArray, PositionArray, SingleArray
from index.bounds import Question, box_bounds, first_bounds, row_bounds

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

    def looked(self, boxes: PositionArray, n_first: int) -> tuple[Any, Any, SingleArray]:
        """Return steps, totals and the least bounds by the first groups."""
        steps = np.empty((len(boxes), SIZE), np.uint16)
        totals = np.empty((len(boxes), SIZE), np.float32)
        least = np.empty(len(boxes), np.float32)
        first = np.ascontiguousarray(self.codes[:, :n_first])
        first_bounds(first, boxes, self.question, steps, totals, least)
        return steps, totals, least

    def collected(
        self, boxes: PositionArray, n_first: int, limit: float
    ) -> tuple[PositionArray, SingleArray]:
        """Return the positions within a limit, and their bounds."""
        steps, totals, _ = self.looked(boxes, n_first)
        n_rows, n_rest = len(self.codes) * SIZE, self.codes.shape[1] - n_first
        rest = np.ascontiguousarray(self.codes[:, n_first:].transpose(0, 2, 1)).reshape(n_rows, n_rest)
        positions = np.empty(len(boxes) * SIZE, np.int64)
        bounds = np.empty(len(positions), np.float32)
        found = row_bounds(rest, boxes, self.question, steps, totals, limit, positions, bounds)
        return positions[:found], bounds[:found]


@given(seed=seeds)
def test_boxes_are_bounded_by_the_formula(seed: int) -> None:
    case = Case(seed)
    lows, highs = (np.ascontiguousarray(end(case.codes, axis=2).T) for end in (np.min, np.max))
    bounds = np.empty(len(case.codes), np.float32)
    box_bounds(lows, highs, case.question, bounds)
    np.testing.assert_array_equal(bounds, case.slow(case.away(lows, highs)))
    assert (bounds <= case.rows().min(axis=1)).all()


@given(seed=seeds, data=st.data())
def test_exactly_the_rows_within_the_limit_are_collected_in_order(seed: int, data: st.DataObject) -> None:
    case = Case(seed)
    expected = case.rows()
    boxes = np.flatnonzero(np.random.default_rng(seed).random(len(case.codes)) < 0.7)
    n_first = data.draw(st.integers(1, case.codes.shape[1]))
    borders = [*expected.reshape(-1).tolist(), 0.0, np.inf]
    limit = data.draw(st.sampled_from(borders))  # that of a row: equal ones are within
    positions, bounds = case.collected(boxes, n_first, limit)
    inside = [(box * SIZE + r, expected[box, r]) for box in boxes for r in range(SIZE)]
    inside = [(position, bound) for position, bound in inside if bound <= limit]
    assert positions.tolist() == [position for position, _ in inside]
    assert bounds.tolist() == [bound for _, bound in inside]


@given(seed=seeds, data=st.data())
def test_what_the_first_groups_tell_of_a_box_holds_for_all_of_its_rows(
    seed: int, data: st.DataObject
) -> None:
    case = Case(seed)
    boxes = np.arange(len(case.codes))
    n_first = data.draw(st.integers(1, case.codes.shape[1]))
    _, _, least = case.looked(boxes, n_first)
    assert (least <= case.rows().min(axis=1)).all()
    if len(set(case.blocks[:n_first])) == 1:  # then nothing is lost by bounding block by block
        codes = case.codes[:, :n_first].transpose(1, 0, 2)
        steps = case.away(codes, codes).sum(axis=0, dtype=float).min(axis=1)
        expected = float(case.weights[0]) * steps**case.power
        np.testing.assert_array_equal(least, expected)


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
