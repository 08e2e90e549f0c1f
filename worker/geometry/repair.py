"""Repair: one vertex a position, no empty or double faces, one direction a piece."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from worker.arrays import BoolArray, FloatArray, IntArray
from worker.errors import Code, MeshError
from worker.geometry.orientation import face_edges, flipped_faces, undirected
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
    flipped, orientable = flipped_faces(faces)
    corners = np.tile(np.arange(3), (len(faces), 1))
    corners[flipped] = [0, 2, 1]
    used, faces = _renumbered(np.take_along_axis(faces, corners, axis=1), len(vertices))
    components = count_components(faces, used.size)
    warnings += _loose(welded, used) + _described(faces, flipped, orientable, components)
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


def weld(vertices: FloatArray) -> IntArray:
    """Return for each vertex the first with exactly the same position: (n, 3) → (n,).

    A negative zero equals zero.
    """
    return first_equal_rows(vertices + 0.0)


def first_equal_rows(rows: FloatArray | IntArray) -> IntArray:
    """Return for each row the first that equals it: (n, k) → (n,)."""
    order = np.lexsort(rows.T)  # stable: equal rows stay in order
    ordered = rows[order]
    fresh = np.ones(len(rows), dtype=np.bool_)
    fresh[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
    first = np.empty(len(rows), dtype=np.int64)
    first[order] = order[fresh][np.cumsum(fresh) - 1]
    return first


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


def empty_faces(vertices: FloatArray, faces: IntArray) -> BoolArray:
    """Return which faces have no area: (n, 3), (m, 3) → (m,)."""
    a, b, c = (vertices[faces[:, corner]] for corner in range(3))
    edges = np.stack([b - a, c - b, a - c])  # (3, m, 3)
    longest = (edges**2).sum(axis=2).max(axis=0)  # squared
    doubled = np.linalg.norm(np.cross(edges[0], edges[1]), axis=1)
    empty: BoolArray = doubled <= FLATNESS * longest
    return empty


def count_components(faces: IntArray, n_vertices: int) -> int:
    """Count connected pieces of a mesh whose vertices are all used."""
    edges = face_edges(faces)
    graph = coo_array((np.ones(len(edges), dtype=np.int8), edges.T), shape=(n_vertices, n_vertices))
    n_components, _ = connected_components(graph, directed=False)
    return int(n_components)


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


def _described(faces: IntArray, flipped: BoolArray, orientable: bool, components: int) -> list[str]:
    edges = np.sort(undirected(face_edges(faces)))
    uses = np.diff(np.flatnonzero(np.diff(edges, prepend=-1, append=-1)))
    return [
        *_counted(int(flipped.sum()), "faces were turned to face as their neighbours do"),
        *([] if orientable else ["the surface has only one side, like a Möbius strip"]),
        *_counted(int((uses > 2).sum()), "edges are shared by more than two faces"),
        *_counted(int((uses == 1).sum()), "edges are open: the surface has a border"),
        *([f"the mesh is in {components:,} pieces"] if components > 1 else []),
    ]


def _counted(count: int, what: str) -> list[str]:
    return [f"{count:,} {what}"] if count else []
