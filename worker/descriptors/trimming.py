"""Averages over the best part of a surface, compiled."""

import numpy as np

from worker.arrays import SingleArray
from worker.compiled import compiled


@compiled
def trimmed_mean(values: SingleArray, shares: SingleArray, kept: float) -> float:
    """Average values by area over the least of them.

    Nothing is sorted: the part in which the border lies is halved again and again (Hoare 1961, Find).

    Parameters
    ----------
    values : (p,) array
    shares : (p,) array
        Of the area, positive.
    kept : float
        How much of the area counts, as a part of it.

    Returns
    -------
    float
        The integral of the quantiles up to ``kept``, divided by it.
    """
    left, weights = values.copy(), shares.copy()
    area = 0.0
    for weight in shares:
        area += weight
    wanted = kept * area
    total, below = 0.0, 0.0  # of what lies before the start
    start, end = int(below), len(left)  # a literal 0 would be compiled apart
    while start < end:
        pivot = left[(start + end) // 2]
        first, last = _part(left, weights, start, end, pivot)
        under, sums = _weigh(left, weights, start, first)
        level, _ = _weigh(left, weights, first, last)
        if below + under >= wanted:
            end = first
        elif below + under + level >= wanted:
            return float(total + sums + (wanted - below - under) * pivot) / wanted
        else:
            start, below, total = last, below + under + level, total + sums + level * pivot
    return total / wanted


@compiled
def _part(
    values: SingleArray, weights: SingleArray, start: int, end: int, pivot: np.float32
) -> tuple[int, int]:
    """Bring those less than the pivot to the front, the greater to the back; return where the equal lie."""
    place = start
    while place < end:
        if values[place] < pivot:
            _swap(values, weights, place, start)
            start, place = start + 1, place + 1
        elif values[place] > pivot:
            end -= 1
            _swap(values, weights, place, end)
        else:
            place += 1
    return start, end


@compiled
def _swap(values: SingleArray, weights: SingleArray, one: int, other: int) -> None:
    values[one], values[other] = values[other], values[one]
    weights[one], weights[other] = weights[other], weights[one]


@compiled
def _weigh(values: SingleArray, weights: SingleArray, start: int, end: int) -> tuple[float, float]:
    """Return the sums of weights and of weighted values of a range."""
    weight, total = 0.0, 0.0
    for i in range(start, end):
        weight += weights[i]
        total += weights[i] * np.float64(values[i])
    return weight, total
