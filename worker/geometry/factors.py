"""A sparse symmetric matrix as a product L D Lᵀ of blocks, without exchanges between fronts.

Each front is eliminated by panels: with the pivot block A₁₁ and the rest A₁₂ of a panel's rows, H = A₁₁⁻¹ A₁₂
is kept, and A₂₂ − A₁₂ᵀ H goes on. All work is products of small dense matrices.
"""

from dataclasses import dataclass

import numpy as np

from worker.arrays import FloatArray, IntArray
from worker.compiled import compiled
from worker.geometry.fronts import Fronts

PANEL = 32  # columns eliminated at once
STRIP = 96  # rows brought up to date at once: only what is right of the diagonal is computed
TINY = 1e-13  # a pivot relative to the largest entry of the diagonal, below which it counts as 0


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
    n_groups = len(groups) - 1
    widths = groups[1:] - groups[:-1]
    n_panels = ((widths + PANEL - 1) // PANEL).sum()
    panels = np.empty((n_panels, 4), np.int64)
    every = np.empty(
        len(rows) + (widths * widths).sum() + (widths // PANEL * (begins[1:] - begins[:-1])).sum(), np.int64
    )
    panel, n_rows = 0, 0
    for group in range(n_groups):
        begin, end = groups[group], groups[group + 1]
        for first in range(begin, end, PANEL):
            last = min(first + PANEL, end)
            n_own = n_rows
            for place in range(last, end):
                every[n_rows] = place
                n_rows += 1
            for k in range(begins[group], begins[group + 1]):
                every[n_rows] = rows[k]
                n_rows += 1
            panels[panel, 0], panels[panel, 1] = first, last - first
            panels[panel, 2], panels[panel, 3] = n_own, n_rows - n_own
            panel += 1
    return panels, every[:n_rows].copy()


@compiled
def _factorised(
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
    """Factor front by front, children before parents; return what `_eliminate` does."""
    n_groups = len(groups) - 1
    sizes = groups[1:] - groups[:-1] + begins[1:] - begins[:-1]
    largest = sizes.max()
    buffer, work = np.empty(largest * largest), np.empty((2 * PANEL + STRIP + 8) * (largest + PANEL))
    local = np.empty(len(order), np.int64)
    stack, used, n_waiting = np.empty(1 << 16), 0, 0
    waiting = np.empty(n_groups, np.int64)
    least = TINY * np.abs(diagonal).max()
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
        found, offset = _eliminate(front, width, least, blocks, offset, work)
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


@compiled
def _eliminate(
    front: FloatArray, width: int, least: float, blocks: FloatArray, offset: int, work: FloatArray
) -> tuple[int, int]:
    """Eliminate the first rows of a front (its upper triangle), in place, and keep their blocks.

    Returns
    -------
    negative : int
        Negative pivots; −1 where one is 0.
    offset : int
        Where the next blocks begin.
    """
    size, negative = len(front), 0
    for first in range(0, width, PANEL):
        last = min(first + PANEL, width)
        n_own, n_rest = last - first, size - last
        inverse = blocks[offset : offset + n_own * n_own].reshape(n_own, n_own)
        offset += n_own * n_own
        for i in range(n_own):
            for j in range(i, n_own):
                inverse[i, j] = inverse[j, i] = front[first + i, first + j]
        found = _invert(inverse, least)
        if found < 0:
            return -1, offset
        negative += found
        if n_rest > 0:
            panel = work[: n_own * n_rest].reshape(n_own, n_rest)
            for i in range(n_own):
                panel[i] = front[first + i, last:]
            product = blocks[offset : offset + n_own * n_rest].reshape(n_own, n_rest)
            offset += n_own * n_rest
            np.dot(inverse, panel, product)
            _subtract(front[last:, last:], product, panel, work[n_own * n_rest :])
    return negative, offset


@compiled
def _subtract(rest: FloatArray, product: FloatArray, panel: FloatArray, work: FloatArray) -> None:
    """Subtract productᵀ panel from the upper triangle of a square, in place."""
    n_own, n_rest = panel.shape
    for first in range(0, n_rest, STRIP):
        last = min(first + STRIP, n_rest)
        n_rows, n_columns = last - first, n_rest - first
        left = work[: n_rows * n_own].reshape(n_rows, n_own)
        for i in range(n_rows):
            for k in range(n_own):
                left[i, k] = product[k, first + i]
        right = panel
        used = n_rows * n_own
        if first > 0:
            right = work[used : used + n_own * n_columns].reshape(n_own, n_columns)
            used += n_own * n_columns
            for k in range(n_own):
                right[k] = panel[k, first:]
        change = work[used : used + n_rows * n_columns].reshape(n_rows, n_columns)
        np.dot(left, right, change)
        for i in range(n_rows):
            row = rest[first + i]
            for j in range(i, n_columns):
                row[first + j] -= change[i, j]


@compiled
def _invert(matrix: FloatArray, least: float) -> int:
    """Invert a symmetric matrix in place; return how many pivots are negative, −1 where one is small.

    Gauss-Jordan elimination, the largest entry of the diagonal first.
    """
    n, negative = len(matrix), 0
    done = np.zeros(n, np.bool_)
    for _ in range(n):
        k = -1
        for i in range(n):
            if not done[i] and (k < 0 or abs(matrix[i, i]) > abs(matrix[k, k])):
                k = i
        pivot = matrix[k, k]
        if not abs(pivot) > least:
            return -1
        done[k] = True
        negative += pivot < 0
        row = matrix[k]
        for j in range(n):
            row[j] /= pivot
        row[k] = 1.0 / pivot
        for i in range(n):
            if i != k:
                other = matrix[i]
                factor = other[k]
                other[k] = 0.0
                for j in range(n):
                    other[j] -= factor * row[j]
    return negative


def solve(factors: Factors, sides: FloatArray) -> FloatArray:
    """Return the solutions for right-hand sides; both (b, n), contiguous."""
    fronts = factors.fronts
    return _solved(fronts.order, factors.panels, factors.rows, factors.offsets, factors.blocks, sides)


@compiled
def _solved(
    order: IntArray,
    panels: IntArray,
    rows: IntArray,
    offsets: IntArray,
    blocks: FloatArray,
    sides: FloatArray,
) -> FloatArray:
    """Bring sides into the order of the fronts, one place a row, and solutions back."""
    n_sides, n = sides.shape
    solution, solved = np.empty((n, n_sides)), np.empty((n_sides, n))
    for place in range(n):
        for k in range(n_sides):
            solution[place, k] = sides[k, order[place]]
    _solve(panels, rows, offsets, blocks, solution)
    for place in range(n):
        for k in range(n_sides):
            solved[k, order[place]] = solution[place, k]
    return solved


@compiled
def _solve(
    panels: IntArray, rows: IntArray, offsets: IntArray, blocks: FloatArray, solution: FloatArray
) -> None:
    """Solve in place, in the order of the fronts."""
    n_columns = solution.shape[1]
    work = np.empty((panels[:, 3].max() + PANEL) * n_columns)
    for panel in range(len(panels)):
        begin, n_own, first, n_rest = panels[panel]
        if n_rest > 0:
            product = blocks[offsets[panel] + n_own * n_own : offsets[panel + 1]].reshape(n_own, n_rest)
            change = work[: n_rest * n_columns].reshape(n_rest, n_columns)
            np.dot(product.T, solution[begin : begin + n_own], change)
            for i in range(n_rest):
                place = rows[first + i]
                for j in range(n_columns):
                    solution[place, j] -= change[i, j]
    for panel in range(len(panels) - 1, -1, -1):
        begin, n_own, first, n_rest = panels[panel]
        own = work[: n_own * n_columns].reshape(n_own, n_columns)
        inverse = blocks[offsets[panel] : offsets[panel] + n_own * n_own].reshape(n_own, n_own)
        np.dot(inverse, solution[begin : begin + n_own], own)
        solution[begin : begin + n_own] = own
        if n_rest > 0:
            product = blocks[offsets[panel] + n_own * n_own : offsets[panel + 1]].reshape(n_own, n_rest)
            known = work[n_own * n_columns : (n_own + n_rest) * n_columns].reshape(n_rest, n_columns)
            for i in range(n_rest):
                place = rows[first + i]
                for j in range(n_columns):
                    known[i, j] = solution[place, j]
            np.dot(product, known, own)
            solution[begin : begin + n_own] -= own
