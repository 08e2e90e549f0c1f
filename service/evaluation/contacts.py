"""Contacts welded together: what a scanner makes of a hand on a hip."""

from collections.abc import Iterator

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import cKDTree

from service.evaluation.joining import append, painted, select_faces
from worker.arrays import FloatArray, IntArray
from worker.geometry.areas import face_vectors
from worker.geometry.colour import look_up_colours
from worker.geometry.edges import find_edges, lengths_of
from worker.geometry.welding import weld
from worker.reading.mesh import Mesh

REACH = 0.03  # length of the longest weld, as a share of √area: 4 cm on a person
AWAY = 0.2  # distance along the surface between the ends of a weld, at least; the same unit
ENDS = 400  # vertices from which welds are looked for


def weld_contacts(mesh: Mesh, strength: int, random: np.random.Generator) -> Mesh:
    """Join places that nearly touch but lie far apart along the surface, by tunnels.

    At each of the two places a triangle gives way to one end of the tunnel. A surface without such places
    stays as it is.
    """
    kept = np.ones(len(mesh.faces), dtype=bool)
    joined = mesh
    for first, second in _contacts(mesh, strength, random):
        kept[[first, second]] = False
        joined = append(joined, _tunnel(mesh, first, second))
    return select_faces(joined, np.concatenate([kept, np.ones(len(joined.faces) - len(kept), dtype=bool)]))


def _contacts(mesh: Mesh, wanted: int, random: np.random.Generator) -> Iterator[tuple[int, int]]:
    """Yield pairs of faces at the ends of the shortest welds, no vertex and no neighbourhood twice."""
    faces = weld(mesh.vertices)[mesh.faces]  # a seam where a file splits vertices is no border
    unit = np.sqrt(np.linalg.norm(face_vectors(mesh.vertices, faces), axis=1).sum())
    face_of = dict(zip(faces.ravel().tolist(), np.repeat(np.arange(len(faces)), 3).tolist(), strict=True))
    taken: list[FloatArray] = []
    used: set[int] = set()
    for first, second in _near_but_far(mesh.vertices, faces, unit, random):
        middle = mesh.vertices[[first, second]].mean(axis=0)
        corners = set(faces[[face_of[first], face_of[second]]].ravel().tolist())
        apart = all(np.linalg.norm(middle - other) > 2 * REACH * unit for other in taken)
        if apart and len(corners - used) == 6 and len(taken) < wanted:
            taken.append(middle)
            used |= corners
            yield face_of[first], face_of[second]


def _near_but_far(
    vertices: FloatArray, faces: IntArray, unit: float, random: np.random.Generator
) -> list[tuple[int, int]]:
    """Return pairs of vertices that are near in space and far along the surface, the nearest first."""
    named = np.unique(faces)
    ends = random.choice(named, min(ENDS, len(named)), replace=False)
    along = dijkstra(_edge_graph(vertices, faces), directed=False, indices=ends, limit=AWAY * unit)  # (e, n)
    tree = cKDTree(vertices[named])
    pairs = []
    for end, distances in zip(ends, along, strict=True):
        near = named[tree.query_ball_point(vertices[end], REACH * unit)]
        far = near[np.isinf(distances[near])]
        if len(far):
            lengths = np.linalg.norm(vertices[far] - vertices[end], axis=1)
            pairs.append((float(lengths.min()), int(end), int(far[lengths.argmin()])))
    return [(first, second) for _, first, second in sorted(pairs)]


def _edge_graph(vertices: FloatArray, faces: IntArray) -> sparse.csr_array:
    edges = find_edges(faces)
    n = len(vertices)
    return sparse.csr_array((lengths_of(vertices, edges), edges.ends.T), shape=(n, n))


def _tunnel(mesh: Mesh, first: int, second: int) -> Mesh:
    """Return six triangles between the outlines of two, turned so that the tunnel is short."""
    ring, other = mesh.faces[first], mesh.faces[second][::-1]
    turns = [np.roll(other, turn) for turn in range(3)]
    gaps = [np.linalg.norm(mesh.vertices[ring] - mesh.vertices[turn], axis=1).sum() for turn in turns]
    corners = np.concatenate([ring, turns[int(np.argmin(gaps))]])  # (6,)
    colours = np.vstack([_corner_colours(mesh, first), _corner_colours(mesh, second)])
    colours = colours[
        [*range(3), *(3 + int(np.flatnonzero(mesh.faces[second] == c)[0]) for c in corners[3:])]
    ]
    faces = np.array(
        [(k, (k + 1) % 3, 3 + k) for k in range(3)]
        + [((k + 1) % 3, 3 + (k + 1) % 3, 3 + k) for k in range(3)]
    )
    return painted(mesh, mesh.vertices[corners], faces, colours[faces])


def _corner_colours(mesh: Mesh, face: int) -> FloatArray:
    return look_up_colours(mesh, np.full(3, face), np.eye(3))
