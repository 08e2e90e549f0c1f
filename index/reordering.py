"""Reordering rows in the memory that they have."""

import numpy as np
import numpy.typing as npt

from index.arrays import PositionArray, RowArray
from index.compiled import compiled

BoolArray = npt.NDArray[np.bool_]


def reorder(rows: RowArray, order: PositionArray) -> None:
    """Let row i be what row order[i] was, for the first of the rows; what is not in the order is lost.

    Parameters
    ----------
    rows : (n, width) array
        Changed in place.
    order : (m,) array
        Distinct positions, m ≤ n.
    """
    _reorder(rows, order, np.zeros(len(order), np.bool_))


@compiled
def _reorder(rows: RowArray, order: PositionArray, done: BoolArray) -> None:
    wanted = np.zeros(len(rows), np.bool_)
    for i in range(len(order)):
        wanted[order[i]] = True
    for end in range(len(order)):  # first the chains that end at a row which nobody takes
        if not wanted[end]:
            _follow(rows, order, done, end)
    aside = np.empty_like(rows[0])
    for start in range(len(order)):  # then the circles
        if not done[start]:
            aside[:] = rows[start]
            last = _follow(rows, order, done, start)
            rows[last] = aside


@compiled
def _follow(rows: RowArray, order: PositionArray, done: BoolArray, start: int) -> int:
    """Move rows from a start on until the next was moved before or is beyond; return the last one."""
    i = start
    while True:
        done[i] = True
        source = order[i]
        if source < len(order) and done[source]:
            return i
        rows[i] = rows[source]
        if source >= len(order):
            return i
        i = source
