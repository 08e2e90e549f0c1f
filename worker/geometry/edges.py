"""The edges of a triangulated surface, each once."""

from dataclasses import dataclass

import numpy as np

from worker.arrays import FloatArray, IntArray


@dataclass(frozen=True, kw_only=True, eq=False)
class Edges:
    """Every edge of a mesh once, with the faces it bounds."""

    ends: IntArray  # (e, 2), indices of vertices, the smaller first
    n_faces: IntArray  # (e,), how many faces share the edge: 1 at a boundary, 2 inside
    of_faces: IntArray  # (m, 3), the edge from corner i to corner i + 1 of each face


def find_edges(faces: IntArray) -> Edges:
    """List the edges of faces (m, 3)."""
    halves = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)  # (3 m, 2)
    keys = halves[:, 0] * (int(faces.max(initial=0)) + 1) + halves[:, 1]
    _, first, inverse, counts = np.unique(keys, return_index=True, return_inverse=True, return_counts=True)
    return Edges(ends=halves[first], n_faces=counts, of_faces=inverse.reshape(-1, 3))


def lengths_of(vertices: FloatArray, edges: Edges) -> FloatArray:
    """Measure edges; (e,)."""
    start, end = vertices[edges.ends[:, 0]], vertices[edges.ends[:, 1]]
    return np.asarray(np.linalg.norm(end - start, axis=1))
