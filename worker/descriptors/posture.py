"""Posture: how far points of a surface lie apart in space, which bending changes and nothing else does.

The distribution of straight distances between points of a surface (Osada, Funkhouser, Chazelle and Dobkin
2002, D2): the same for a surface that is turned, mirrored or meshed anew.
"""

import numpy as np

from worker.arrays import FloatArray, SingleArray
from worker.compiled import compiled
from worker.geometry.sampling import cell_areas, farthest_points

POINTS = 512  # farthest points whose distances are taken
STEP = 1.0  # units of distance from one number to the next
STEPS = 1_024  # numbers; what lies further apart counts as this far


def posture(vertices: FloatArray, areas: FloatArray) -> SingleArray:
    """Return the share of pairs of points that lie no further apart than 1, 2, 3 … STEPs.

    Parameters
    ----------
    vertices : (n, 3) array
        Of a surface scaled to its canonical area.
    areas : (n,) array
        Of the vertices.

    Returns
    -------
    (STEPS,) array
        Ascends to 1.
    """
    points = farthest_points(vertices, POINTS)
    shares = cell_areas(vertices, points, areas)
    return _cumulated(np.ascontiguousarray(vertices[points]), shares / shares.sum()).astype(np.float32)


def posture_distance(one: SingleArray, other: SingleArray) -> float:
    """Return by how many units of length the distances between points differ on average.

    The least mean step that turns one distribution into the other (Wasserstein, order 1).
    """
    return float(STEP * np.abs(one - other).sum(dtype=np.float64))


@compiled
def _cumulated(points: FloatArray, shares: FloatArray) -> FloatArray:
    counts = np.zeros(STEPS)
    for i in range(len(points)):
        for j in range(i):
            square = 0.0
            for axis in range(3):
                square += (points[i, axis] - points[j, axis]) ** 2
            place = np.sqrt(square) / STEP
            counts[min(int(place), STEPS - 1)] += shares[i] * shares[j]
    total = counts.sum()
    return np.cumsum(counts) / total if total > 0.0 else np.ones(STEPS)
