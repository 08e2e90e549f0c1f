"""Farthest-point samples of a point set."""

import numpy as np
from scipy.spatial import cKDTree

from worker.arrays import FloatArray, IntArray


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
    picked = np.empty(n_samples, dtype=np.int64)
    picked[0] = np.argmax(np.sum((points - points.mean(axis=0)) ** 2, axis=1))
    columns = np.ascontiguousarray(points.T)  # (d, n)
    nearest, squares, rest = np.full(len(points), np.inf), np.empty(len(points)), np.empty_like(columns)
    for k in range(1, n_samples):
        np.subtract(columns, columns[:, picked[k - 1], None], out=rest)
        np.multiply(rest, rest, out=rest)
        np.sum(rest, axis=0, out=squares)
        np.minimum(nearest, squares, out=nearest)
        picked[k] = nearest.argmax()
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
