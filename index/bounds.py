"""Bounds: at least how far boxes of rows, and the rows in them, are from a query.

With codes c and a query between `below` and `above` (see `index.coding`), a row is at least
max(c − above, below − c, 0) steps away in each group, and groups add up to Σ_b w_b (Σ_{g in b})^p.
"""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from index.arrays import ByteArray, PositionArray, SingleArray
from index.compiled import compiled

StepArray = npt.NDArray[np.uint16]  # enough for 257 groups
BoolArray = npt.NDArray[np.bool_]
FEW = 16  # bounds looked at together


class Question(NamedTuple):
    """A query in codes, and how they are weighed."""

    below: ByteArray  # (g,)
    above: ByteArray  # (g,)
    weights: SingleArray  # (g,), of a sum of steps
    ends: BoolArray  # (g,), whether steps are not added to the next group's: weighed otherwise, squared apart
    power: int  # p

    @classmethod
    def of(
        cls, below: ByteArray, above: ByteArray, blocks: PositionArray, weights: SingleArray, power: int
    ) -> "Question":
        """Return the question of a query between below and above, in groups of some blocks; (g,) each."""
        others = (blocks[:-1] != blocks[1:]) & ((power != 1) | (weights[:-1] != weights[1:]))
        return cls(below=below, above=above, weights=weights, ends=np.append(others, True), power=power)


@compiled
def box_bounds(lows: ByteArray, highs: ByteArray, question: Question, out: SingleArray) -> None:
    """Bound the distance of every row in each box.

    Parameters
    ----------
    lows, highs : (g, n) arrays
        Least and greatest code of each box.
    question : Question
    out : (n,) array
    """
    below, above, weights, ends, power = question
    steps = np.zeros(lows.shape[1], np.uint16)
    out[:] = np.float32(0)
    for g in range(len(lows)):
        _add_box_steps(lows[g], highs[g], below[g], above[g], steps)
        if ends[g]:
            _add_power(steps, weights[g], power, out)
            steps[:] = np.uint16(0)


@compiled
def least_bounds(codes: ByteArray, boxes: PositionArray, question: Question, out: SingleArray) -> None:
    """Bound the distance of all rows in some boxes by the codes of each.

    Parameters
    ----------
    codes : (n, g, r) array
        Of each box's rows.
    boxes : (m,) array
        Which boxes.
    question : Question
    out : (m,) array
    """
    below, above, weights, ends, power = question
    steps = np.empty(codes.shape[2], np.uint16)
    out[:] = np.float32(0)
    for place in range(len(boxes)):
        rows = codes[boxes[place]]
        steps[:] = np.uint16(0)
        for g in range(len(rows)):
            _add_steps(rows[g], below[g], above[g], steps)
            if ends[g]:
                step = np.float32(_least(steps))
                out[place] += weights[g] * (step if power == 1 else step * step)
                steps[:] = np.uint16(0)


@compiled
def rows_within(
    codes: ByteArray, boxes: PositionArray, question: Question, limit: float, positions: PositionArray
) -> int:
    """Collect the rows of some boxes whose bound is within a limit.

    Parameters
    ----------
    codes, boxes, question
        As for `least_bounds`.
    limit : float
    positions : array
        Room for the rows found: box · r + place in it, ascending where the boxes are.

    Returns
    -------
    int
        How many were found.
    """
    below, above, weights, ends, power = question
    size, found = codes.shape[2], 0
    steps, total = np.empty(size, np.uint16), np.empty(size, np.float32)
    for box in boxes:
        rows = codes[box]
        steps[:], total[:] = np.uint16(0), np.float32(0)
        for g in range(len(rows)):
            _add_steps(rows[g], below[g], above[g], steps)
            if ends[g]:
                _add_power(steps, weights[g], power, total)
                steps[:] = np.uint16(0)
        for start in range(0, size, FEW):
            some = total[start : start + FEW]
            if _count_within(some, np.float32(limit)):
                for place in range(len(some)):
                    if some[place] <= limit:
                        positions[found] = box * size + start + place
                        found += 1
    return found


@compiled
def fine_bounds(codes: ByteArray, rows: PositionArray, question: Question, out: SingleArray) -> None:
    """Bound the distance of some rows.

    Parameters
    ----------
    codes : (n, g) array
    rows : (m,) array
        Which rows.
    question : Question
    out : (m,) array
    """
    below, above, weights, ends, power = question
    sums = np.flatnonzero(ends) + 1  # where each sum ends
    for place in range(len(rows)):
        row = codes[rows[place]]
        start, total = np.int64(0), np.float32(0)
        for end in sums:
            steps = np.float32(_steps_of(row[start:end], below[start:end], above[start:end]))
            total += weights[start] * (steps if power == 1 else steps * steps)
            start = end
        out[place] = total


@compiled
def _count_within(bounds: SingleArray, limit: np.float32) -> int:
    count = np.int32(0)
    for i in range(len(bounds)):
        count = np.int32(count + np.int32(bounds[i] <= limit))
    return int(count)


@compiled
def _steps_of(codes: ByteArray, below: ByteArray, above: ByteArray) -> int:
    total = np.int32(0)
    for g in range(len(codes)):
        over = np.uint8(codes[g] - above[g]) if codes[g] > above[g] else np.uint8(0)
        under = np.uint8(below[g] - codes[g]) if below[g] > codes[g] else np.uint8(0)
        total = np.int32(total + np.int32(over | under))
    return int(total)


# Differences of bytes that stop at 0, of which a processor takes 32 at a time.
@compiled
def _add_steps(codes: ByteArray, below: np.uint8, above: np.uint8, steps: StepArray) -> None:
    for i in range(len(steps)):
        over = np.uint8(codes[i] - above) if codes[i] > above else np.uint8(0)
        under = np.uint8(below - codes[i]) if below > codes[i] else np.uint8(0)
        steps[i] = np.uint16(steps[i] + np.uint16(over | under))


@compiled
def _add_box_steps(
    lows: ByteArray, highs: ByteArray, below: np.uint8, above: np.uint8, steps: StepArray
) -> None:
    for i in range(len(steps)):
        over = np.uint8(lows[i] - above) if lows[i] > above else np.uint8(0)
        under = np.uint8(below - highs[i]) if below > highs[i] else np.uint8(0)
        steps[i] = np.uint16(steps[i] + np.uint16(over | under))


@compiled
def _least(steps: StepArray) -> np.uint16:
    least = np.uint16(65535)
    for i in range(len(steps)):
        least = min(least, steps[i])
    return least


@compiled
def _add_power(steps: StepArray, weight: np.float32, power: int, total: SingleArray) -> None:
    if power == 1:
        for i in range(len(steps)):
            total[i] += weight * np.float32(steps[i])
    else:
        for i in range(len(steps)):
            step = np.float32(steps[i])
            total[i] += weight * (step * step)
