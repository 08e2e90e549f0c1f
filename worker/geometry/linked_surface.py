"""A surface whose faces are linked around each vertex, so that two vertices join in one step."""

from typing import NamedTuple

import numpy as np

from worker.arrays import BoolArray, FloatArray, IntArray
from worker.compiled import compiled


class LinkedSurface(NamedTuple):
    """What collapses change."""

    vertices: FloatArray  # (n, 3)
    faces: IntArray  # (m, 3)
    present: BoolArray  # (m,), faces that are left
    quadrics: FloatArray  # (n, 9), as from `plane_quadrics`
    border: BoolArray  # (n,), whether the vertex lies on an open edge
    penalties: FloatArray  # (n,), 1 or more
    marks: IntArray  # (n,), the number of the last search that met a vertex
    first: IntArray  # (n,), the first corner 3 f + k at a vertex; −1 where it is gone
    last: IntArray  # (n,)
    following: IntArray  # (3 m,), the next corner at the same vertex, or −1


def linked(vertices: FloatArray, faces: IntArray, quadrics: FloatArray, border: BoolArray) -> LinkedSurface:
    """Return a surface of vertices (n, 3), faces (m, 3), quadrics (n, 9) and vertices at a border (n,)."""
    n = len(vertices)
    surface = LinkedSurface(
        vertices=vertices,
        faces=faces,
        present=np.ones(len(faces), dtype=np.bool_),
        quadrics=quadrics,
        border=border,
        penalties=np.ones(n),
        marks=np.full(n, -1),
        first=np.full(n, -1),
        last=np.full(n, -1),
        following=np.full(faces.size, -1),
    )
    _link(surface)
    return surface


def compact(surface: LinkedSurface) -> tuple[FloatArray, IntArray, FloatArray, BoolArray]:
    """Drop what is gone; return vertices, faces, quadrics, border."""
    faces = surface.faces[surface.present]
    named = np.zeros(len(surface.vertices), dtype=np.bool_)
    named[faces] = True
    new = np.cumsum(named) - 1
    return surface.vertices[named], new[faces], surface.quadrics[named], surface.border[named]


@compiled
def _link(surface: LinkedSurface) -> None:
    for corner in range(surface.faces.size):
        _append(surface, surface.faces[corner // 3, corner % 3], corner)


@compiled
def valence(surface: LinkedSurface, vertex: int) -> int:
    """Count neighbours: as many as faces, one more at a border."""
    count = int(surface.border[vertex])
    corner = surface.first[vertex]
    while corner >= 0:
        count += 1
        corner = surface.following[corner]
    return count


@compiled
def n_shared(surface: LinkedSurface, start: int, end: int) -> int:
    """Count the faces at an edge."""
    count, corner = 0, surface.first[start]
    while corner >= 0:
        for place in range(3):
            count += surface.faces[corner // 3, place] == end
        corner = surface.following[corner]
    return count


@compiled
def merge(surface: LinkedSurface, kept: int, gone: int) -> None:
    """Let the faces of one vertex name the other, drop those that name both, and calm the surroundings."""
    surface.following[surface.last[kept]] = surface.first[gone]
    corner, surface.first[kept], surface.first[gone] = surface.first[kept], -1, -1
    while corner >= 0:
        face, following, both = corner // 3, surface.following[corner], 0
        for place in range(3):
            if surface.faces[face, place] == gone:
                surface.faces[face, place] = kept
            both += surface.faces[face, place] == kept
        surface.following[corner] = -1
        if both == 1:
            _append(surface, kept, corner)
        elif surface.present[face]:
            surface.present[face] = False
            _unlink(surface, face, kept)
        corner = following


@compiled
def _append(surface: LinkedSurface, vertex: int, corner: int) -> None:
    if surface.first[vertex] < 0:
        surface.first[vertex] = corner
    else:
        surface.following[surface.last[vertex]] = corner
    surface.last[vertex] = corner
    for place in range(3):
        surface.penalties[surface.faces[corner // 3, place]] = 1.0


@compiled
def _unlink(surface: LinkedSurface, face: int, kept: int) -> None:
    """Take a face off the list of its vertex that stays as it is."""
    for place in range(3):
        vertex = surface.faces[face, place]
        if vertex != kept:
            corner, before = surface.first[vertex], -1
            while corner != 3 * face + place:
                before, corner = corner, surface.following[corner]
            if before < 0:
                surface.first[vertex] = surface.following[corner]
            else:
                surface.following[before] = surface.following[corner]
            if surface.last[vertex] == corner:
                surface.last[vertex] = before
