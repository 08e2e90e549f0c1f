"""Matching landmarks: each point's nearest in the space of descriptors, compiled.

Innermost loops run along the query's points, and none of their steps needs another's result: processors do
eight or sixteen of them at once.
"""

import numpy as np
import numpy.typing as npt

from worker.arrays import SingleArray
from worker.compiled import compiled

Places = npt.NDArray[np.int32]
Single = np.float32

FAINTEST = (
    -60.0
)  # log of the least weight of a soft match: numbers below the normal ones are slow to multiply
TERMS = 8  # of the exponential's series about 0, on half an octave: the rest is below single precision

_HALF, _FAR, _FIRST = Single(0.5), Single(np.inf), np.int32(0)
_OCTAVES = Single(1.0 / np.log(2.0))  # in a factor of e
_FEWEST = Single(FAINTEST / np.log(2.0))  # octaves
_SERIES = tuple(Single(np.log(2.0) ** k / np.prod(np.arange(1.0, k + 1.0))) for k in range(TERMS))  # of 2^x
_BIAS, _EXPONENT = np.int32(127), np.int32(2**23)  # of single precision (IEEE 754)


@compiled
def match_rates(own: SingleArray, others: SingleArray, squares: SingleArray, nearest: SingleArray) -> None:
    """Compare points by their rates.

    Parameters
    ----------
    own : (6, p) array
    others : (6, n) array
    squares : (n, p) array
        Is given all squared distances.
    nearest : (p,) array
        Is given the least of them for each own point.
    """
    for i in range(len(nearest)):
        nearest[i] = _FAR
    for j in range(others.shape[1]):
        a, b, c = others[0, j], others[1, j], others[2, j]
        d, e, f = others[3, j], others[4, j], others[5, j]
        for i in range(own.shape[1]):
            u, v, w = own[0, i] - a, own[1, i] - b, own[2, i] - c
            x, y, z = own[3, i] - d, own[4, i] - e, own[5, i] - f
            square = (u * u + v * v + w * w) + (x * x + y * y + z * z)
            squares[j, i] = square
            nearest[i] = square if square < nearest[i] else nearest[i]


@compiled
def match_jointly(
    squares: SingleArray, own: SingleArray, others: SingleArray, nearest: SingleArray, matches: Places
) -> None:
    """Compare points by their rates and colours together.

    Parameters
    ----------
    squares : (n, p) array
        Squared distances by rates.
    own : (3, p) array
        Colours, in units of a rate.
    others : (3, n) array
    nearest : (p,) array
        Is given the least squared distance of each own point.
    matches : (p,) array
        Is given where that is; the first of several.
    """
    for i in range(len(nearest)):
        nearest[i], matches[i] = _FAR, _FIRST
    for j in range(others.shape[1]):
        place = np.int32(j)
        a, b, c = others[0, j], others[1, j], others[2, j]
        for i in range(own.shape[1]):
            u, v, w = own[0, i] - a, own[1, i] - b, own[2, i] - c
            square = squares[j, i] + (u * u + v * v + w * w)
            matches[i] = place if square < nearest[i] else matches[i]
            nearest[i] = square if square < nearest[i] else nearest[i]


@compiled
def match_backwards(squares: SingleArray, own: SingleArray, others: SingleArray) -> SingleArray:
    """Return the least squared distance (n,) of each of the other points, by rates and colours together."""
    found = np.empty(others.shape[1], Single)
    row = np.empty(own.shape[1], Single)
    for j in range(len(found)):
        a, b, c = others[0, j], others[1, j], others[2, j]
        for i in range(len(row)):
            u, v, w = own[0, i] - a, own[1, i] - b, own[2, i] - c
            row[i] = squares[j, i] + (u * u + v * v + w * w)
        found[j] = _least(row)
    return found


@compiled
def soft_colours(
    squares: SingleArray, nearest: SingleArray, softness: float, lab: SingleArray, shares: SingleArray
) -> SingleArray:
    """Return the mean colour (3, p) of the other points about each own one.

    Each counts by its share of the area and by exp(−(d² − d²_nearest) / 2σ²).

    Parameters
    ----------
    squares : (n, p) array
    nearest : (p,) array
        The least of each column.
    softness : float
        σ.
    lab : (3, n) array
    shares : (n,) array
    """
    n_points = len(nearest)
    sums = np.zeros((4, n_points), Single)
    weights, powers = np.empty(n_points, Single), np.empty(n_points, np.int32)
    scale = _HALF / Single(softness * softness) * _OCTAVES
    for j in range(len(shares)):
        for i in range(n_points):
            octaves = max((nearest[i] - squares[j, i]) * scale, _FEWEST)
            whole = np.floor(octaves + _HALF)
            powers[i] = (np.int32(whole) + _BIAS) * _EXPONENT
            weights[i] = _power_of_two(octaves - whole)
        scales = powers.view(Single)
        share, lightness, a, b = shares[j], lab[0, j], lab[1, j], lab[2, j]
        for i in range(n_points):
            weight = weights[i] * scales[i] * share
            sums[0, i] += weight * lightness
            sums[1, i] += weight * a
            sums[2, i] += weight * b
            sums[3, i] += weight
    for k in range(3):
        for i in range(n_points):
            sums[k, i] /= sums[3, i]
    return sums[:3]


@compiled
def _power_of_two(x: np.float32) -> np.float32:
    """Return 2^x for |x| ≤ 1/2, to single precision."""
    total = _SERIES[7]
    total = total * x + _SERIES[6]
    total = total * x + _SERIES[5]
    total = total * x + _SERIES[4]
    total = total * x + _SERIES[3]
    total = total * x + _SERIES[2]
    total = total * x + _SERIES[1]
    return Single(total * x + _SERIES[0])


@compiled
def _least(row: SingleArray) -> np.float32:
    """Return the least number of a row, which is overwritten: folded in half until one is left."""
    n_left = len(row)
    while n_left > 1:
        half = (n_left + 1) // 2
        for i in range(n_left - half):
            row[i] = row[i + half] if row[i + half] < row[i] else row[i]
        n_left = half
    return Single(row[0])
