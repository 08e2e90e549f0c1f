"""A sparse symmetric matrix as a product L D Lᵀ of blocks, without exchanges between fronts.

Multifrontal: Duff and Reid (1983); the signs of the pivots tell the inertia (Sylvester's law), so that a
count of eigenvalues comes with each factorisation.
"""

from dataclasses import dataclass

import numpy as np

from worker.arrays import FloatArray, IntArray
from worker.compiled import compiled
from worker.geometry.elimination import STRIP, WIDE, eliminate, panel_width
from worker.geometry.fronts import Fronts

TINY = 1e-13  # a pivot relative to what stood in its place at first, or to the median, below which it is 0


@dataclass(frozen=True, kw_only=True, eq=False)
class Factors:
    """The blocks of a factorised matrix, in the order of its fronts."""

    fronts: Fronts
    panels: IntArray  # (p, 4), of each panel: first place, width, first of its rows, their number
    rows: IntArray  # places, those of each panel
    offsets: IntArray  # (p + 1,), where the blocks of each panel begin
    blocks: FloatArray  # A₁₁⁻¹ and H of each panel, by rows
    negative: int  # how many eigenvalues of the matrix are below 0 (Sylvester's law of inertia)


def factorise(
    fronts: Fronts, starts: IntArray, neighbours: IntArray, weights: FloatArray, diagonal: FloatArray
) -> Factors | None:
    """Factor a symmetric matrix.

    Parameters
    ----------
    fronts : Fronts
        Of its pattern.
    starts, neighbours, weights : (n + 1,), (e,), (e,) arrays
        Entries outside the diagonal, both of each pair, by columns; what is on it here is not read.
    diagonal : (n,) array

    Returns
    -------
    Factors, or None
        None where a pivot is 0 to rounding.
    """
    panels, rows = _panels(fronts.groups, fronts.begins, fronts.rows)
    offsets = np.concatenate([[0], np.cumsum(panels[:, 1] * (panels[:, 1] + panels[:, 3]))])
    blocks = np.empty(offsets[-1])
    negative = _factorised(
        fronts.order,
        fronts.places,
        fronts.groups,
        fronts.begins,
        fronts.rows,
        fronts.parents,
        starts,
        neighbours,
        weights,
        diagonal,
        blocks,
    )
    if negative < 0:
        return None
    return Factors(fronts=fronts, panels=panels, rows=rows, offsets=offsets, blocks=blocks, negative=negative)


@compiled
def _panels(groups: IntArray, begins: IntArray, rows: IntArray) -> tuple[IntArray, IntArray]:
    """Cut fronts into panels: those of a front follow each other, the later ones are rows of the earlier."""
    n_panels, n_rows = 0, 0
    for group in range(len(groups) - 1):  # counts, with rows to spare
        width, n_rest = groups[group + 1] - groups[group], begins[group + 1] - begins[group]
        n_own = (width - 1) // panel_width(width + n_rest) + 1
        n_panels += n_own
        n_rows += n_own * (width + n_rest)
    panels, every = np.empty((n_panels, 4), np.int64), np.empty(n_rows, np.int64)
    panel, used = 0, 0
    for group in range(len(groups) - 1):
        begin, end = groups[group], groups[group + 1]
        n_rest = begins[group + 1] - begins[group]
        step = panel_width(end - begin + n_rest)
        for first in range(begin, end, step):
            last = min(first + step, end)
            n_later = end - last
            panels[panel] = first, last - first, used, n_later + n_rest
            every[used : used + n_later] = np.arange(last, end)
            every[used + n_later : used + n_later + n_rest] = rows[begins[group] : begins[group + 1]]
            used += n_later + n_rest
            panel += 1
    return panels, every[:used].copy()


@compiled
def _factorised(  # noqa: C901 - compiled: one loop, plainly
    order: IntArray,
    places: IntArray,
    groups: IntArray,
    begins: IntArray,
    rows: IntArray,
    parents: IntArray,
    starts: IntArray,
    neighbours: IntArray,
    weights: FloatArray,
    diagonal: FloatArray,
    blocks: FloatArray,
) -> int:
    """Factor front by front, children before parents; return what `eliminate` counts."""
    n_groups = len(groups) - 1
    sizes = groups[1:] - groups[:-1] + begins[1:] - begins[:-1]
    largest = sizes.max()
    buffer, work = np.empty(largest * largest), np.empty((2 * WIDE + STRIP) * (largest + WIDE))
    local = np.empty(len(order), np.int64)
    stack, used, n_waiting = np.empty(1 << 16), 0, 0
    waiting = np.empty(n_groups, np.int64)
    # A vertex of almost no area has a diagonal that says nothing of how exact its pivot is.
    least = TINY * np.minimum(np.abs(diagonal[order]), np.median(np.abs(diagonal)))
    offset, negative = 0, 0
    for group in range(n_groups):
        begin, end, size = groups[group], groups[group + 1], sizes[group]
        width = end - begin
        front = buffer[: size * size].reshape(size, size)
        for i in range(size):
            front[i, i:] = 0.0
        for k in range(width):
            local[begin + k] = k
        for k in range(begins[group], begins[group + 1]):
            local[rows[k]] = width + k - begins[group]
        for place in range(begin, end):
            vertex = order[place]
            row = front[place - begin]
            for k in range(starts[vertex], starts[vertex + 1]):
                other = places[neighbours[k]]
                if other > place:
                    row[local[other]] += weights[k]
            row[place - begin] += diagonal[vertex]
        while n_waiting > 0 and parents[waiting[n_waiting - 1]] == group:
            n_waiting -= 1
            child = waiting[n_waiting]
            own = local[rows[begins[child] : begins[child + 1]]]
            n_rest = len(own)
            used -= n_rest * n_rest
            for i in range(n_rest):
                row = front[own[i]]
                for j in range(i, n_rest):
                    row[own[j]] += stack[used + i * n_rest + j]
        found, offset = eliminate(front, width, least[begin:end], blocks, offset, work)
        if found < 0:
            return -1
        negative += found
        n_rest = size - width
        if n_rest > 0:
            if used + n_rest * n_rest > len(stack):
                longer = np.empty(2 * (used + n_rest * n_rest))
                longer[:used] = stack[:used]
                stack = longer
            rest = stack[used : used + n_rest * n_rest].reshape(n_rest, n_rest)
            for i in range(n_rest):
                rest[i, i:] = front[width + i, width + i :]
            used += n_rest * n_rest
            waiting[n_waiting] = group
            n_waiting += 1
    return negative
