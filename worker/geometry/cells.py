"""Cells: which samples of a surface lie nearest to which vertex, and means over them."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from worker.arrays import FloatArray, IntArray
from worker.compiled import compiled

CUBES = 1_000_000  # of the grid, about; fewer, larger ones for what is spread out


@dataclass(frozen=True, kw_only=True, eq=False)
class Cells:
    """A partition of samples among vertices."""

    nearest: IntArray  # (k,), the vertex of each sample
    counts: IntArray  # (n,), samples of each vertex
    empty: IntArray  # (e,), vertices without any
    lent: IntArray  # (e,), the sample whose value each of those takes


def cells_of(
    points: FloatArray, normals: FloatArray, centres: FloatArray, centre_normals: FloatArray, turn: float
) -> Cells:
    """Give each sample to the nearest vertex.

    Distance counts the turn of the normal as well, so that the two sides of a thin wall stay apart.

    Parameters
    ----------
    points, normals : (k, 3) arrays
        The samples; unit normals.
    centres, centre_normals : (n, 3) arrays
        The vertices; unit normals.
    turn : float
        The distance that a quarter turn of the normal counts for, about an edge.

    Returns
    -------
    Cells
    """
    weight = turn / np.sqrt(2.0)  # unit normals a quarter turn apart are √2 apart
    samples = np.hstack([points, weight * normals])  # (k, 6)
    vertices = np.hstack([centres, weight * centre_normals])  # (n, 6)
    nearest = nearest_of(samples, vertices, turn)
    counts = np.bincount(nearest, minlength=len(centres))
    empty = np.flatnonzero(counts == 0)
    lent = np.asarray(cKDTree(samples).query(vertices[empty])[1]) if len(empty) else empty
    return Cells(nearest=nearest, counts=counts, empty=empty, lent=lent)


def cell_means(values: FloatArray, cells: Cells) -> FloatArray:
    """Average the values (k, d) of samples over the cell of each vertex; (n, d)."""
    n_vertices = len(cells.counts)
    sums = np.stack([np.bincount(cells.nearest, column, n_vertices) for column in values.T], axis=1)
    means = sums / np.maximum(cells.counts, 1)[:, None]
    means[cells.empty] = values[cells.lent]
    return np.asarray(means)


def nearest_of(points: FloatArray, centres: FloatArray, reach: float) -> IntArray:
    """Find the nearest centre of each point.

    Centres are looked for on a grid of the first three coordinates, where distances are no longer than in
    all; points with none within reach are left to a tree.

    Parameters
    ----------
    points, centres : (k, d), (n, d) arrays
        d is 3 or more.
    reach : float
        Within which most points have a centre.

    Returns
    -------
    (k,) array
    """
    lower, upper = centres[:, :3].min(axis=0), centres[:, :3].max(axis=0)
    side = max(reach, float(np.cbrt(np.prod(upper - lower + reach) / CUBES)))
    shape = np.floor((upper - lower) / side).astype(np.int64) + 3  # an empty layer around
    cubes = np.floor((centres[:, :3] - lower) / side).astype(np.int64) + 1
    keys = (cubes[:, 0] * shape[1] + cubes[:, 1]) * shape[2] + cubes[:, 2]
    order = np.argsort(keys, kind="stable")
    starts = np.concatenate([[0], np.cumsum(np.bincount(keys, minlength=int(shape.prod())))])
    nearest = _search(points, centres[order], starts, shape, lower, side)
    far = np.flatnonzero(nearest < 0)
    found: IntArray = order[nearest]
    if len(far):
        found[far] = cKDTree(centres).query(points[far])[1]
    return found


@compiled
def _search(
    points: FloatArray, centres: FloatArray, starts: IntArray, shape: IntArray, lower: FloatArray, side: float
) -> IntArray:
    """Look through the 27 cubes around each point; −1 where the nearest may lie outside of them."""
    nearest = np.full(len(points), -1)
    for point in range(len(points)):
        x = int(np.floor((points[point, 0] - lower[0]) / side)) + 1
        y = int(np.floor((points[point, 1] - lower[1]) / side)) + 1
        z = int(np.floor((points[point, 2] - lower[2]) / side)) + 1
        if not (0 < x < shape[0] - 1 and 0 < y < shape[1] - 1 and 0 < z < shape[2] - 1):
            continue
        least = side * side
        for i in range(x - 1, x + 2):
            for j in range(y - 1, y + 2):
                key = (i * shape[1] + j) * shape[2] + z
                for centre in range(starts[key - 1], starts[key + 2]):
                    square = 0.0
                    for axis in range(points.shape[1]):
                        step = points[point, axis] - centres[centre, axis]
                        square += step * step
                    if square < least:
                        least, nearest[point] = square, centre
    return nearest
