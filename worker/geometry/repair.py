"""Repair: one vertex a position, no empty or double faces, one direction a piece."""

from dataclasses import dataclass

import numpy as np

from worker.arrays import BoolArray, FloatArray, IntArray
from worker.compiled import compiled
from worker.errors import Code, MeshError
from worker.geometry.edges import Edges, find_edges
from worker.geometry.orientation import flipped_faces
from worker.geometry.pieces import count_components
from worker.geometry.welding import first_equal_rows, weld
from worker.reading.mesh import Mesh

FLATNESS = 1e-13  # a triangle is empty where twice its area is this part of its longest edge squared


@dataclass(frozen=True, kw_only=True, eq=False)
class Repaired:
    """A surface whose neighbours share vertices."""

    vertices: FloatArray  # (n, 3), the file's unit, centred on the mean of the file's vertices; each is used
    faces: IntArray  # (m, 3)
    source_faces: IntArray  # (m,), index into the mesh's faces
    source_corners: (
        IntArray  # (m, 3), which corner of the source face each corner is: 0 2 1 where it was turned
    )
    components: int  # connected pieces
    warnings: tuple[str, ...]  # what was mended, in plain words


def repair(mesh: Mesh) -> Repaired:
    """Weld, drop what is empty or double, and orient; every piece is kept.

    Vertices are welded where their positions are exactly equal. Faces of one piece that meet along
    an edge of two faces get the same direction, the one of the greater number, where that is possible.

    Raises
    ------
    MeshError
        NO_FACES, ZERO_AREA
    """
    if not len(mesh.faces):
        raise MeshError(Code.NO_FACES, "The mesh holds no faces.")
    vertices = _centred(mesh.vertices)
    welded = weld(mesh.vertices)  # (n_read,)
    faces = welded[mesh.faces]
    kept, warnings = _kept_faces(vertices, faces)
    faces = faces[kept]
    edges = find_edges(faces)
    flipped, orientable = flipped_faces(faces, edges)
    corners = np.tile(np.arange(3), (len(faces), 1))
    corners[flipped] = [0, 2, 1]
    used, faces = _renumbered(np.take_along_axis(faces, corners, axis=1), len(vertices))
    components = count_components(faces, used.size)
    warnings += _loose(welded, used) + _described(edges, flipped, orientable, components)
    return Repaired(
        vertices=vertices[used],
        faces=faces,
        source_faces=np.flatnonzero(kept),
        source_corners=corners,
        components=components,
        warnings=tuple(warnings),
    )


def _centred(vertices: FloatArray) -> FloatArray:
    """Subtract the mean: far from the origin, areas would drown in rounding."""
    centred: FloatArray = vertices - vertices.mean(axis=0)
    return centred


def _kept_faces(vertices: FloatArray, faces: IntArray) -> tuple[BoolArray, list[str]]:
    """Return which faces stay (m,): those with an area, the first of equal ones."""
    full = ~empty_faces(vertices, faces)
    if not full.any():
        raise MeshError(
            Code.ZERO_AREA, f"All {len(faces):,} faces have no area: their corners coincide or lie on a line."
        )
    first = np.zeros(len(faces), dtype=np.bool_)
    rows = np.flatnonzero(full)
    same = first_equal_rows(np.sort(faces[rows], axis=1))
    first[rows[same == np.arange(rows.size)]] = True
    return first, [
        *_counted(int((~full).sum()), "faces without area were dropped"),
        *_counted(int((full & ~first).sum()), "double faces were dropped"),
    ]


@compiled
def empty_faces(vertices: FloatArray, faces: IntArray) -> BoolArray:
    """Return which faces have no area: (n, 3), (m, 3) → (m,)."""
    empty = np.empty(len(faces), dtype=np.bool_)
    for face in range(len(faces)):
        a, b, c = vertices[faces[face, 0]], vertices[faces[face, 1]], vertices[faces[face, 2]]
        x, y, z = b[0] - a[0], b[1] - a[1], b[2] - a[2]
        u, v, w = c[0] - b[0], c[1] - b[1], c[2] - b[2]
        longest = max(x * x + y * y + z * z, u * u + v * v + w * w)
        longest = max(longest, (x + u) ** 2 + (y + v) ** 2 + (z + w) ** 2)  # squared
        p, q, r = y * w - z * v, z * u - x * w, x * v - y * u
        empty[face] = np.sqrt(p * p + q * q + r * r) <= FLATNESS * longest
    return empty


def _renumbered(faces: IntArray, n_vertices: int) -> tuple[IntArray, IntArray]:
    """Return the vertices in use, ascending, and the faces that number them anew."""
    named = np.zeros(n_vertices, dtype=np.bool_)
    named[faces] = True
    return np.flatnonzero(named), (np.cumsum(named) - 1)[faces]


def _loose(welded: IntArray, used: IntArray) -> list[str]:
    distinct = welded == np.arange(welded.size)
    named = np.zeros(welded.size, dtype=np.bool_)
    named[used] = True
    return [
        *_counted(int((~distinct).sum()), "vertices at the position of another were joined with it"),
        *_counted(int((distinct & ~named).sum()), "vertices that no face uses were dropped"),
    ]


def _described(edges: Edges, flipped: BoolArray, orientable: bool, components: int) -> list[str]:
    return [
        *_counted(int(flipped.sum()), "faces were turned to face as their neighbours do"),
        *([] if orientable else ["the surface has only one side, like a Möbius strip"]),
        *_counted(int((edges.n_faces > 2).sum()), "edges are shared by more than two faces"),
        *_counted(int((edges.n_faces == 1).sum()), "edges are open: the surface has a border"),
        *([f"the mesh is in {components:,} pieces"] if components > 1 else []),
    ]


def _counted(count: int, what: str) -> list[str]:
    return [f"{count:,} {what}"] if count else []
