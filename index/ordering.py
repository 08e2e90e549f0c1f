"""Ordering: rows with similar codes come to lie side by side, so that a box of them is small."""

import numpy as np

from index.arrays import ByteArray, DoubleArray, PositionArray
from index.compiled import compiled

LOOKED_AT = 1024  # rows by which a group is chosen


def by_halves(codes: ByteArray, widths: DoubleArray, box: int) -> PositionArray:
    """Order rows by halving them again and again along the group that spreads most.

    As a kd-tree does (Bentley 1975), with a box of rows in each leaf.

    Parameters
    ----------
    codes : (n, g) array
    widths : (g,) array
        What a step of each group counts.
    box : int
        Rows in a leaf; all but the last are full.

    Returns
    -------
    (n,) array
        Which row comes to each place.
    """
    return _halve(codes, widths, box)


@compiled
def _halve(codes: ByteArray, widths: DoubleArray, box: int) -> PositionArray:
    order = np.arange(len(codes))
    aside = np.empty_like(order)
    waiting = [(0, len(codes))]
    while len(waiting) > 0:
        start, end = waiting.pop()
        n_boxes = (end - start + box - 1) // box
        if n_boxes > 1:
            group = _widest(codes, widths, order[start:end])
            _sort(codes[:, group], order[start:end], aside[start:end])
            middle = start + n_boxes // 2 * box
            waiting.append((middle, end))
            waiting.append((start, middle))
    return order


@compiled
def _widest(codes: ByteArray, widths: DoubleArray, rows: PositionArray) -> int:
    """Return the group with the greatest deviation among some of the rows."""
    step = max(1, len(rows) // LOOKED_AT)
    chosen, most = 0, -1.0
    for group in range(codes.shape[1]):
        total, squares, count = 0, 0, 0
        for i in range(0, len(rows), step):
            code = int(codes[rows[i], group])
            total += code
            squares += code * code
            count += 1
        variance = (squares / count - (total / count) ** 2) * widths[group] ** 2
        if variance > most:
            chosen, most = group, variance
    return chosen


@compiled
def _sort(keys: ByteArray, rows: PositionArray, aside: PositionArray) -> None:
    """Sort rows by their keys, in place, by counting; equal ones keep their order."""
    ends = np.zeros(257, np.int64)
    for i in range(len(rows)):
        ends[int(keys[rows[i]]) + 1] += 1
    for value in range(256):
        ends[value + 1] += ends[value]
    for i in range(len(rows)):
        key = keys[rows[i]]
        aside[ends[key]] = rows[i]
        ends[key] += 1
    for i in range(len(rows)):
        rows[i] = aside[i]
