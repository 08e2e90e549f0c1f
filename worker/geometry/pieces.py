"""Pieces: what is connected with what (union of sets, Tarjan 1975)."""

import numpy as np

from worker.arrays import IntArray
from worker.compiled import compiled


@compiled
def count_components(faces: IntArray, n_vertices: int) -> int:
    """Count connected pieces of a mesh (m, 3) whose vertices are all used."""
    parents = np.arange(n_vertices)
    count = n_vertices
    for face in range(len(faces)):
        for corner in range(2):
            first, second = _root(parents, faces[face, corner]), _root(parents, faces[face, corner + 1])
            if first != second:
                parents[max(first, second)] = min(first, second)
                count -= 1
    return count


@compiled
def _root(parents: IntArray, member: int) -> int:
    while parents[member] != member:
        parents[member] = parents[parents[member]]
        member = parents[member]
    return member
