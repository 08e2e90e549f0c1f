"""Dense elimination: the first rows of a symmetric matrix, block by block.

With the pivot block A₁₁ of a panel of rows and the rest A₁₂ of those rows, H = A₁₁⁻¹ A₁₂ is kept, and
A₂₂ − A₁₂ᵀ H goes on. All work is products of small dense matrices.
"""

import numpy as np

from worker.arrays import FloatArray
from worker.compiled import compiled

NARROW, WIDE = 32, 96  # rows eliminated at once
LARGE = 400  # order of a front from which the wider panels pay
STRIP = 96  # rows brought up to date at once: only what is right of the diagonal is computed


@compiled
def panel_width(size: int) -> int:
    """Return how many rows of a front of some order are eliminated at once."""
    return WIDE if size >= LARGE else NARROW


@compiled
def eliminate(
    front: FloatArray, width: int, least: FloatArray, blocks: FloatArray, offset: int, work: FloatArray
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
    panel_rows = panel_width(size)
    for first in range(0, width, panel_rows):
        last = min(first + panel_rows, width)
        n_own, n_rest = last - first, size - last
        inverse = blocks[offset : offset + n_own * n_own].reshape(n_own, n_own)
        offset += n_own * n_own
        for i in range(n_own):
            for j in range(i, n_own):
                inverse[i, j] = inverse[j, i] = front[first + i, first + j]
        found = _invert(inverse, least[first:last])
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
def _invert(matrix: FloatArray, least: FloatArray) -> int:
    """Invert a symmetric matrix in place; return how many pivots are negative, −1 where one is 0.

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
        if not abs(pivot) > least[k]:
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
