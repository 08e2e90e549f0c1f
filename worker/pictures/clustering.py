"""Fewer vertices at once: those in one cube of a grid become one."""

import numpy as np

from worker.arrays import FloatArray, IntArray


def cluster(
    vertices: FloatArray, faces: IntArray, colours: FloatArray, cubes: int
) -> tuple[FloatArray, IntArray, FloatArray]:
    """Merge the vertices of each cube into their mean, and drop the faces that collapse.

    J. Rossignac, P. Borrel, *Multi-resolution 3D approximations for rendering complex scenes* (1993).

    Parameters
    ----------
    vertices : (n, 3) array
    faces : (m, 3) array
    colours : (n, 3) array
    cubes : int
        Along the longest side of the bounding box.

    Returns
    -------
    vertices, faces, colours
        The same for the smaller mesh.
    """
    lower = vertices.min(0)
    step = float(np.ptp(vertices, axis=0).max()) / cubes or 1.0
    places = np.floor((vertices - lower) / step).astype(np.int64)
    keys = (places[:, 0] * (cubes + 1) + places[:, 1]) * (cubes + 1) + places[:, 2]
    _, owner, counts = np.unique(keys, return_inverse=True, return_counts=True)
    merged = owner[faces]
    whole = (merged != np.roll(merged, 1, axis=1)).all(axis=1)
    kept = np.unique(merged[whole], axis=0)
    return _means(vertices, owner, counts), kept, _means(colours, owner, counts)


def _means(values: FloatArray, owner: IntArray, counts: IntArray) -> FloatArray:
    sums = [np.bincount(owner, column, len(counts)) for column in values.T]
    return np.stack(sums, axis=1) / counts[:, None]
