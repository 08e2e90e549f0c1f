"""Cells: which samples of a surface lie nearest to which vertex, and means over them."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from worker.arrays import FloatArray, IntArray
from worker.compiled import compiled

RINGS = 3  # of cubes around a point's own that are looked through
FEW = 50  # points for which a grid does not pay
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
    search = nearest_of if len(empty) > FEW else nearest_one_by_one
    lent = search(vertices[empty], samples, turn)
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
    shape = np.floor((upper - lower) / side).astype(np.int64) + 1 + 2 * RINGS  # with empty layers around
    cubes = np.floor((centres[:, :3] - lower) / side).astype(np.int64) + RINGS
    keys = (cubes[:, 0] * shape[1] + cubes[:, 1]) * shape[2] + cubes[:, 2]
    order = np.argsort(keys, kind="stable")
    starts = np.concatenate([[0], np.cumsum(np.bincount(keys, minlength=int(shape.prod())))])
    nearest = np.full(len(points), -1)
    for ring in range(1, RINGS + 1):
        _search(points, nearest, centres[order], starts, shape, lower, side, ring)
    far = np.flatnonzero(nearest < 0)
    found: IntArray = order[nearest]
    if len(far):
        found[far] = cKDTree(centres).query(points[far])[1]
    return found


@compiled
def nearest_one_by_one(points: FloatArray, centres: FloatArray, _: float) -> IntArray:
    """Find the nearest centre of each of a few points, as `nearest_of` does, by looking at all of them."""
    nearest = np.empty(len(points), dtype=np.int64)
    for point in range(len(points)):
        least = np.inf
        for centre in range(len(centres)):
            square = 0.0
            for axis in range(points.shape[1]):
                step = points[point, axis] - centres[centre, axis]
                square += step * step
            if square < least:
                least, nearest[point] = square, centre
    return nearest


@compiled
def _search(
    points: FloatArray,
    nearest: IntArray,
    centres: FloatArray,
    starts: IntArray,
    shape: IntArray,
    lower: FloatArray,
    side: float,
    ring: int,
) -> None:
    """Look through the cubes around each point that has no centre yet, as far as ``ring`` cubes away."""
    for point in range(len(points)):
        x = int(np.floor((points[point, 0] - lower[0]) / side)) + RINGS
        y = int(np.floor((points[point, 1] - lower[1]) / side)) + RINGS
        z = int(np.floor((points[point, 2] - lower[2]) / side)) + RINGS
        within = x >= ring and y >= ring and z >= ring
        within = within and x + ring < shape[0] and y + ring < shape[1] and z + ring < shape[2]
        if nearest[point] >= 0 or not within:
            continue
        least = (ring * side) ** 2  # all centres that are nearer lie in these cubes
        for i in range(x - ring, x + ring + 1):
            for j in range(y - ring, y + ring + 1):
                key = (i * shape[1] + j) * shape[2] + z
                for centre in range(starts[key - ring], starts[key + ring + 1]):
                    square = 0.0
                    for axis in range(points.shape[1]):
                        step = points[point, axis] - centres[centre, axis]
                        square += step * step
                    if square < least:
                        least, nearest[point] = square, centre
