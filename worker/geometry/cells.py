"""Cells: which samples of a surface lie nearest to which vertex, and means over them."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from worker.arrays import FloatArray, IntArray


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
    nearest = np.asarray(cKDTree(vertices).query(samples)[1])  # (k,)
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
