"""Farthest-point samples of a point set."""

import numpy as np
from scipy.spatial import cKDTree

from worker.arrays import FloatArray, IntArray
from worker.compiled import compiled
from worker.geometry.edges import stable_order

PER_BUCKET = 12.0  # points, about, where they lie on a surface
ROUNDING = 1e-12  # more than the relative error of a squared distance


def farthest_points(points: FloatArray, n_samples: int) -> IntArray:
    """Pick points one by one, each the farthest from those picked before.

    Gonzalez (1985); the first is the farthest from the centroid.

    Parameters
    ----------
    points : (n, d) array
    n_samples : int
        At most this many; all points where there are no more.

    Returns
    -------
    (min(n, n_samples),) array
        Indices of points, in the order of picking.
    """
    n_samples = min(n_samples, len(points))
    first = int(np.argmax(np.sum((points - points.mean(axis=0)) ** 2, axis=1)))
    order, buckets = _buckets(points)
    return _picked(np.ascontiguousarray(points[order]), order, buckets, first, n_samples)


def _buckets(points: FloatArray) -> tuple[IntArray, IntArray]:
    """Order points by the cubes of a grid that they lie in; return the order and where each cube begins."""
    heights = points - points.min(axis=0)
    size = float(heights.max()) * np.sqrt(PER_BUCKET / len(points)) or 1.0
    cubes = (heights / size).astype(np.int64)
    keys = np.ravel_multi_index(tuple(cubes.T), tuple(cubes.max(axis=0) + 1))
    order = stable_order(keys)
    return order, np.flatnonzero(np.r_[True, np.diff(keys[order]) != 0, True])


@compiled
def _picked(  # noqa: C901 - compiled: one loop, plainly
    points: FloatArray, order: IntArray, buckets: IntArray, first: int, n_samples: int
) -> IntArray:
    """Pick the farthest points; of equally far ones that with the least index.

    Only buckets that may hold a point nearer to the latest than to all before are visited.
    """
    n_points, n_axes = points.shape
    n_buckets = len(buckets) - 1
    low, high = np.empty((n_buckets, n_axes)), np.empty((n_buckets, n_axes))
    for bucket in range(n_buckets):
        for axis in range(n_axes):
            inside = points[buckets[bucket] : buckets[bucket + 1], axis]
            low[bucket, axis], high[bucket, axis] = inside.min(), inside.max()
    nearest = np.full(n_points, np.inf)
    farthest, where = np.full(n_buckets, np.inf), buckets[:-1].copy()
    picked = np.empty(n_samples, np.int64)
    picked[0] = first
    latest = points[0].copy()
    for place in range(n_points):
        if order[place] == first:
            latest[:] = points[place]
    for k in range(1, n_samples):
        best = 0
        for bucket in range(n_buckets):
            bound = 0.0
            for axis in range(n_axes):
                gap = max(low[bucket, axis] - latest[axis], latest[axis] - high[bucket, axis], 0.0)
                bound += gap * gap
            if bound * (1.0 - ROUNDING) < farthest[bucket]:
                farthest[bucket] = -1.0
                for place in range(buckets[bucket], buckets[bucket + 1]):
                    square = 0.0
                    for axis in range(n_axes):
                        gap = points[place, axis] - latest[axis]
                        square += gap * gap
                    nearest[place] = min(nearest[place], square)
                    if nearest[place] > farthest[bucket]:
                        farthest[bucket], where[bucket] = nearest[place], place
            if farthest[bucket] > farthest[best] or (
                farthest[bucket] == farthest[best] and order[where[bucket]] < order[where[best]]
            ):
                best = bucket
        picked[k] = order[where[best]]
        latest[:] = points[where[best]]
    return picked


def cell_areas(points: FloatArray, samples: IntArray, areas: FloatArray) -> FloatArray:
    """Sum the areas of the points nearest to each sample.

    Parameters
    ----------
    points : (n, d) array
    samples : (s,) array
        Indices of points.
    areas : (n,) array

    Returns
    -------
    (s,) array
        Sums to the sum of the areas.
    """
    nearest = cKDTree(points[samples]).query(points)[1]
    return np.bincount(nearest, areas, len(samples)).astype(np.float64)
