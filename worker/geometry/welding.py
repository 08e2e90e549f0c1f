"""Equal rows of a table, found by hashing."""

import numpy as np

from worker.arrays import FloatArray, IntArray
from worker.compiled import compiled

MIX = np.uint64(0x9E3779B97F4A7C15)  # 2^64 over the golden ratio (Knuth, The Art of Computer Programming 3)


def weld(vertices: FloatArray) -> IntArray:
    """Return for each vertex the first with exactly the same position: (n, 3) → (n,).

    A negative zero equals zero.
    """
    return first_equal_rows((vertices + 0.0).view(np.int64))


def first_equal_rows(rows: IntArray) -> IntArray:
    """Return for each row the first that equals it: (n, k) → (n,)."""
    size = 1 << (2 * len(rows)).bit_length()  # twice as many places as rows, or more
    return _first_equal(np.ascontiguousarray(rows), np.full(size, -1))


@compiled
def _first_equal(rows: IntArray, places: IntArray) -> IntArray:
    first = np.empty(len(rows), dtype=np.int64)
    for row in range(len(rows)):
        place = _hash(rows[row]) & (len(places) - 1)
        while places[place] >= 0 and not _equal(rows[row], rows[places[place]]):
            place = (place + 1) & (len(places) - 1)
        if places[place] < 0:
            places[place] = row
        first[row] = places[place]
    return first


@compiled
def _hash(row: IntArray) -> int:
    mixed = np.uint64(0)
    for value in row:
        mixed = (mixed ^ np.uint64(value)) * MIX
        mixed ^= mixed >> np.uint64(29)
    return np.int64(mixed >> np.uint64(1))  # type: ignore[return-value]  # numba's int


@compiled
def _equal(row: IntArray, other: IntArray) -> bool:
    same = True
    for place in range(len(row)):
        same = same and row[place] == other[place]
    return same
