"""Exact distances between a query and rows: d = Σ_b w_b ‖x_b − q_b‖₁^p.

Bytes give sums of whole numbers, which no order changes; single numbers are summed in double precision and
always in the same order. So a row's distance is the same, bit for bit, whatever is compared beside it.
"""

import numpy as np
import numpy.typing as npt

from index.arrays import ByteArray, DoubleArray, PositionArray, RowArray, SingleArray
from index.compiled import compiled
from index.layout import Layout
from index.methods import Method

LevelArray = npt.NDArray[np.int32]


def distances(
    rows: RowArray, positions: PositionArray, query: RowArray, layout: Layout, method: Method
) -> DoubleArray:
    """Return the distance of some rows to a query.

    Parameters
    ----------
    rows : (n, width) array
        As the layout keeps them.
    positions : (m,) array
        Which rows.
    query : (width,) array
        Kept in the same way.
    layout : Layout
    method : Method
        Of this layout's blocks, perhaps with other weights.

    Returns
    -------
    (m,) array
    """
    out = np.empty(len(positions))
    weights = layout.weights(method)
    if layout.packings is None:
        numbers = query.astype(np.float64)
        _single_distances(rows, positions, numbers, layout.edges, weights, method.power, out)
    else:
        levels = levels_of(query[None], layout)[0].astype(np.int32)
        parts = (layout.edges, layout.squared, weights, method.power)
        _byte_distances(rows, positions, levels, *parts, out)
    return out


def levels_of(rows: RowArray, layout: Layout) -> DoubleArray:
    """Return rows (m, width) in whole units: what bytes stand for, or the numbers themselves."""
    levels = rows.astype(np.float64)
    if layout.squared.any():
        places = np.repeat(layout.squared, layout.lengths)
        levels[:, places] **= 2
    return levels


@compiled
def _byte_distances(
    rows: ByteArray,
    positions: PositionArray,
    query: LevelArray,
    edges: PositionArray,
    squared: npt.NDArray[np.bool_],
    weights: DoubleArray,
    power: int,
    out: DoubleArray,
) -> None:
    for place in range(len(positions)):
        row = rows[positions[place]]
        total = 0.0
        for b in range(len(weights)):
            mine, other = row[edges[b] : edges[b + 1]], query[edges[b] : edges[b + 1]]
            gap = np.float64(_square_gaps(mine, other) if squared[b] else _gaps(mine, other))
            total += weights[b] * (gap if power == 1 else gap * gap)
        out[place] = total


# Numbers of 32 bits, which a processor takes eight at a time: enough for blocks of 33 000 squares of bytes.
@compiled
def _square_gaps(row: ByteArray, query: LevelArray) -> np.int32:
    total = np.int32(0)
    for i in range(len(row)):
        number = np.int32(row[i])
        total = np.int32(total + abs(np.int32(np.int32(number * number) - query[i])))
    return total


@compiled
def _gaps(row: ByteArray, query: LevelArray) -> np.int32:
    total = np.int32(0)
    for i in range(len(row)):
        total = np.int32(total + abs(np.int32(np.int32(row[i]) - query[i])))
    return total


@compiled
def _single_distances(
    rows: SingleArray,
    positions: PositionArray,
    query: DoubleArray,
    edges: PositionArray,
    weights: DoubleArray,
    power: int,
    out: DoubleArray,
) -> None:
    gaps = np.empty(np.max(np.diff(edges)))
    for place in range(len(positions)):
        row = rows[positions[place]]
        total = 0.0
        for b in range(len(weights)):
            gap = _sum_of_gaps(row[edges[b] : edges[b + 1]], query[edges[b] : edges[b + 1]], gaps)
            total += weights[b] * (gap if power == 1 else gap * gap)
        out[place] = total


@compiled
def _sum_of_gaps(row: SingleArray, query: DoubleArray, gaps: DoubleArray) -> float:
    """Add pair by pair, which rounds least and takes several at a time."""
    size = len(row)
    for i in range(size):
        gaps[i] = abs(np.float64(row[i]) - query[i])
    while size > 1:
        half = (size + 1) // 2
        upper = gaps[half:size]
        for i in range(len(upper)):
            gaps[i] += upper[i]
        size = half
    return float(gaps[0])
