"""Solving with a factorised matrix, for several right-hand sides at once."""

import numpy as np

from worker.arrays import FloatArray, IntArray
from worker.compiled import compiled
from worker.geometry.elimination import WIDE
from worker.geometry.factors import Factors

SIDES = 4  # right-hand sides solved for at once: the factor is read once for all of them


def solve(factors: Factors, sides: FloatArray) -> FloatArray:
    """Return the solutions for right-hand sides; both (SIDES, n), contiguous."""
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
    n = len(order)
    solution, solved = np.empty((n, SIDES)), np.empty((SIDES, n))
    for place in range(n):
        for k in range(SIDES):
            solution[place, k] = sides[k, order[place]]
    _solve(panels, rows, offsets, blocks, solution)
    for place in range(n):
        for k in range(SIDES):
            solved[k, order[place]] = solution[place, k]
    return solved


@compiled
def _solve(
    panels: IntArray, rows: IntArray, offsets: IntArray, blocks: FloatArray, solution: FloatArray
) -> None:
    """Solve in place, in the order of the fronts."""
    work = np.empty((panels[:, 3].max() + WIDE) * SIDES)
    for panel in range(len(panels)):
        begin, n_own, first, n_rest = panels[panel]
        if n_rest > 0:
            product = blocks[offsets[panel] + n_own * n_own : offsets[panel + 1]].reshape(n_own, n_rest)
            change = work[: n_rest * SIDES].reshape(n_rest, SIDES)
            np.dot(product.T, solution[begin : begin + n_own], change)
            for i in range(n_rest):
                place = rows[first + i]
                for j in range(SIDES):
                    solution[place, j] -= change[i, j]
    for panel in range(len(panels) - 1, -1, -1):
        begin, n_own, first, n_rest = panels[panel]
        own = work[: n_own * SIDES].reshape(n_own, SIDES)
        inverse = blocks[offsets[panel] : offsets[panel] + n_own * n_own].reshape(n_own, n_own)
        np.dot(inverse, solution[begin : begin + n_own], own)
        solution[begin : begin + n_own] = own
        if n_rest > 0:
            product = blocks[offsets[panel] + n_own * n_own : offsets[panel + 1]].reshape(n_own, n_rest)
            known = work[n_own * SIDES : (n_own + n_rest) * SIDES].reshape(n_rest, SIDES)
            for i in range(n_rest):
                place = rows[first + i]
                for j in range(SIDES):
                    known[i, j] = solution[place, j]
            np.dot(product, known, own)
            solution[begin : begin + n_own] -= own
