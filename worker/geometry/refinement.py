"""Splitting long edges: more vertices on the very same surface."""

import numpy as np

from worker.arrays import FloatArray, IntArray
from worker.geometry.areas import norms
from worker.geometry.edges import Edges, find_edges, lengths_of


def split_long_edges(vertices: FloatArray, faces: IntArray, longest: float) -> tuple[FloatArray, IntArray]:
    """Halve edges until none is longer than allowed; the surface stays the same set of points.

    Parameters
    ----------
    vertices : (n, 3) array
    faces : (m, 3) array
    longest : float
        Edges over this length are halved.

    Returns
    -------
    vertices : (n', 3) array
        The given vertices first.
    faces : (m', 3) array
    """
    while True:
        edges = find_edges(faces)
        long = lengths_of(vertices, edges) > longest  # (e,)
        if not long.any():
            return vertices, faces
        middles = np.where(long, len(vertices) + np.cumsum(long) - 1, -1)  # (e,)
        vertices = np.vstack([vertices, vertices[edges.ends[long]].mean(axis=1)])
        faces = _split_faces(vertices, faces, edges, middles)


def _split_faces(vertices: FloatArray, faces: IntArray, edges: Edges, middles: IntArray) -> IntArray:
    """Cut each face at the middles (−1: none) of its edges, into two, three or four."""
    of_faces = middles[edges.of_faces]  # (m, 3)
    n_middles = np.count_nonzero(of_faces >= 0, axis=1)
    # Turn each face so that a single middle lies on edge 0, a single whole edge on edge 2.
    turn = np.where(n_middles == 1, np.argmax(of_faces >= 0, axis=1), 0)
    turn = np.where(n_middles == 2, (np.argmax(of_faces < 0, axis=1) + 1) % 3, turn)
    order = (np.arange(3) + turn[:, None]) % 3  # (m, 3)
    corners = np.take_along_axis(faces, order, axis=1)
    cuts = np.take_along_axis(of_faces, order, axis=1)
    parts = [faces[n_middles == 0]]
    for n_cuts, split in ((1, _into_two), (2, _into_three), (3, _into_four)):
        chosen = n_middles == n_cuts
        parts.append(split(vertices, corners[chosen], cuts[chosen]))
    return np.vstack(parts)


def _into_two(_: FloatArray, corners: IntArray, cuts: IntArray) -> IntArray:
    a, b, c = corners.T
    middle = cuts[:, 0]
    return _stack((a, middle, c), (middle, b, c))


def _into_three(vertices: FloatArray, corners: IntArray, cuts: IntArray) -> IntArray:
    a, b, c = corners.T
    ab, bc = cuts[:, 0], cuts[:, 1]
    shorter = norms(vertices[a] - vertices[bc]) < norms(vertices[ab] - vertices[c])
    first = _stack((ab, b, bc), (a, ab, bc), (a, bc, c))
    second = _stack((ab, b, bc), (a, ab, c), (ab, bc, c))
    return np.where(np.tile(shorter, 3)[:, None], first, second)


def _into_four(_: FloatArray, corners: IntArray, cuts: IntArray) -> IntArray:
    a, b, c = corners.T
    ab, bc, ca = cuts.T
    return _stack((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))


def _stack(*triangles: tuple[IntArray, IntArray, IntArray]) -> IntArray:
    return np.vstack([np.column_stack(triangle) for triangle in triangles])
