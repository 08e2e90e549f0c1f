"""Grids whose zero level is a manifold: no square of grid points is checkered."""

import numpy as np

from worker.arrays import BoolArray, FloatArray, IntArray

ROUNDS = 8  # at most; one or two are enough for what is not hostile


def settle(values: FloatArray) -> FloatArray:
    """Turn single signs of a sampled field until no square has them checkered.

    An edge of a surface net lies across one square of the grid and belongs to two quads, but to four where
    the square's corners are inside, outside, inside, outside. Of such a square the corner nearest to the
    surface changes sides.

    Parameters
    ----------
    values : (x, y, z)
        Negative inside.

    Returns
    -------
    values : (x, y, z)
    """
    settled = values.copy()
    for _ in range(ROUNDS):
        corners = np.vstack([_checkered(settled < 0, axis) for axis in range(3)])  # (k, 4, 3)
        if not len(corners):
            break
        sizes = np.abs(settled[tuple(corners.transpose(2, 0, 1))])  # (k, 4)
        chosen = np.unique(corners[np.arange(len(corners)), sizes.argmin(1)], axis=0)
        settled[tuple(chosen.T)] *= -1
    return settled


def _checkered(inside: BoolArray, axis: int) -> IntArray:
    """Return the corners (k, 4, 3) of the checkered squares across ``axis``."""
    u, v = np.delete(np.eye(3, dtype=np.int64), axis, axis=0)
    steps = np.array([0 * u, u, u + v, v])
    shape = np.array(inside.shape) - u - v
    a, b, c, d = (
        inside[tuple(slice(start, start + size) for start, size in zip(step, shape, strict=True))]
        for step in steps
    )
    places = np.argwhere((a == c) & (b == d) & (a != b))
    return np.asarray(places[:, None] + steps)
