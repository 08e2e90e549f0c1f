"""Bounds: at least how far boxes of rows, and the rows in them, are from a query.

With codes c and a query between `below` and `above` (see `index.sketch`), a row is at least
max(c − above, below − c, 0) steps away in each group, and groups add up to Σ_b w_b (Σ_{g in b})^p.
"""

import numpy as np
import numpy.typing as npt

from index.arrays import ByteArray, PositionArray, SingleArray
from index.compiled import compiled

LOOK = 8  # groups after which rows are looked at

StepArray = npt.NDArray[np.uint16]


@compiled
def box_bounds(
    lows: ByteArray,
    highs: ByteArray,
    below: ByteArray,
    above: ByteArray,
    blocks: PositionArray,
    weights: SingleArray,
    power: int,
    out: SingleArray,
) -> None:
    """Bound the distance of every row in each box.

    Parameters
    ----------
    lows, highs : (g, n) arrays
        Least and greatest code of each box.
    below, above : (g,) arrays
        Of the query.
    blocks : (g,) array
        The block of each group.
    weights : (g,) array
        Its weight, for sums in steps.
    power : int
        p.
    out : (n,) array
    """
    steps = np.zeros(lows.shape[1], np.uint16)
    out[:] = np.float32(0)
    for g in range(len(lows)):
        _add_box_steps(lows[g], highs[g], below[g], above[g], steps)
        if _ends_sum(g, blocks, weights, power):
            _add_power(steps, weights[g], power, out)
            steps[:] = np.uint16(0)


@compiled
def least_bounds(
    codes: ByteArray,
    boxes: PositionArray,
    below: ByteArray,
    above: ByteArray,
    blocks: PositionArray,
    weights: SingleArray,
    power: int,
    out: SingleArray,
) -> None:
    """Bound the distance of every row in some boxes, from the codes of the rows in the first groups.

    Parameters
    ----------
    codes, boxes, below, above, blocks, weights, power
        As for `row_bounds`; those of the groups for the first groups alone.
    out : (m,) array
    """
    steps = np.empty(codes.shape[2], np.uint16)
    for place in range(len(boxes)):
        rows = codes[boxes[place]]
        out[place] = np.float32(0)
        steps[:] = np.uint16(0)
        for g in range(len(below)):
            _add_steps(rows[g], below[g], above[g], steps)
            if _ends_sum(g, blocks, weights, power):
                least = np.float32(_least(steps))
                out[place] += weights[g] * (least if power == 1 else least * least)
                steps[:] = np.uint16(0)


@compiled
def row_bounds(
    codes: ByteArray,
    boxes: PositionArray,
    below: ByteArray,
    above: ByteArray,
    blocks: PositionArray,
    weights: SingleArray,
    power: int,
    limit: SingleArray,
    positions: PositionArray,
    bounds: SingleArray,
) -> int:
    """Collect the rows of some boxes that may be within a limit.

    Parameters
    ----------
    codes : (n, g, r) array
        Of each box's rows.
    boxes : (m,) array
        Which boxes.
    below, above, blocks, weights, power
        As for `box_bounds`.
    limit : (1,) array
    positions : array
        Room for the rows found: box · r + place in it, ascending where the boxes are.
    bounds : array
        Room for their bounds.

    Returns
    -------
    int
        How many were found.
    """
    size = codes.shape[2]
    steps, total = np.empty(size, np.uint16), np.empty(size, np.float32)
    found = 0
    for box in boxes:
        if _bound_rows(codes[box], below, above, blocks, weights, power, limit, steps, total):
            for r in range(size):
                if total[r] <= limit[0]:
                    positions[found] = box * size + r
                    bounds[found] = total[r]
                    found += 1
    return found


@compiled
def _bound_rows(
    codes: ByteArray,
    below: ByteArray,
    above: ByteArray,
    blocks: PositionArray,
    weights: SingleArray,
    power: int,
    limit: SingleArray,
    steps: StepArray,
    total: SingleArray,
) -> bool:
    """Bound the rows (g, r) of one box; False as soon as none of them can be within the limit."""
    steps[:] = np.uint16(0)
    total[:] = np.float32(0)
    known = np.float32(0)  # of all rows at once
    start = 0
    while start < len(codes):
        end = start + 1
        while end < min(start + LOOK, len(codes)) and not _ends_sum(end - 1, blocks, weights, power):
            end += 1
        for g in range(start, end):
            _add_steps(codes[g], below[g], above[g], steps)
        least = np.float32(_least(steps))
        most = known + weights[start] * (least if power == 1 else least * least)
        if most > limit[0]:
            return False
        if _ends_sum(end - 1, blocks, weights, power):
            known = most
            _add_power(steps, weights[start], power, total)
            steps[:] = np.uint16(0)
        start = end
    return _any_within(total, limit)


@compiled
def _ends_sum(g: int, blocks: PositionArray, weights: SingleArray, power: int) -> bool:
    """Tell whether steps of group g are not added to those of the next: weighed otherwise or squared apart."""
    if g + 1 == len(blocks):
        return True
    return blocks[g] != blocks[g + 1] and (power != 1 or weights[g] != weights[g + 1])


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
def _any_within(total: SingleArray, limit: SingleArray) -> bool:
    """Tell whether one of some numbers, not negative, is within a limit (1,); their bits have their order."""
    bits, most = total.view(np.int32), limit.view(np.int32)[0]
    least = np.int32(np.iinfo(np.int32).max)
    for i in range(len(bits)):
        least = min(least, bits[i])
    return bool(least <= most)


@compiled
def _add_power(steps: StepArray, weight: np.float32, power: int, total: SingleArray) -> None:
    if power == 1:
        for i in range(len(steps)):
            total[i] += weight * np.float32(steps[i])
    else:
        for i in range(len(steps)):
            step = np.float32(steps[i])
            total[i] += weight * (step * step)
