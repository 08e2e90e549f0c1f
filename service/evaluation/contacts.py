"""Contacts welded together: what a scanner makes of a hand on a hip."""

from collections.abc import Iterator

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import cKDTree

from service.evaluation.joining import append, painted, select_faces
from worker.arrays import FloatArray
from worker.geometry.areas import face_vectors
from worker.geometry.colour import look_up_colours
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
    """Yield pairs of faces at the ends of the shortest welds, no face and no neighbourhood twice."""
    unit = np.sqrt(np.linalg.norm(face_vectors(mesh.vertices, mesh.faces), axis=1).sum())
    ends = random.choice(len(mesh.vertices), min(ENDS, len(mesh.vertices)), replace=False)
    along = dijkstra(_edge_graph(mesh), directed=False, indices=ends, limit=AWAY * unit)  # (e, n)
    tree = cKDTree(mesh.vertices)
    pairs = []
    for end, distances in zip(ends, along, strict=True):
        near = np.array(tree.query_ball_point(mesh.vertices[end], REACH * unit))
        far = near[np.isinf(distances[near])]
        lengths = np.linalg.norm(mesh.vertices[far] - mesh.vertices[end], axis=1)
        if len(far) and lengths.min() > 0:
            pairs.append((float(lengths.min()), int(end), int(far[lengths.argmin()])))
    face_of = dict(
        zip(mesh.faces.ravel().tolist(), np.repeat(np.arange(len(mesh.faces)), 3).tolist(), strict=True)
    )
    taken: list[FloatArray] = []
    for _, first, second in sorted(pairs):
        middle = mesh.vertices[[first, second]].mean(axis=0)
        apart = all(np.linalg.norm(middle - other) > 2 * REACH * unit for other in taken)
        if apart and first in face_of and second in face_of and len(taken) < wanted:
            taken.append(middle)
            yield face_of[first], face_of[second]


def _edge_graph(mesh: Mesh) -> sparse.csr_array:
    edges = np.vstack([mesh.faces[:, [0, 1]], mesh.faces[:, [1, 2]], mesh.faces[:, [2, 0]]])
    edges = np.unique(np.sort(edges, axis=1), axis=0)
    lengths = np.linalg.norm(mesh.vertices[edges[:, 0]] - mesh.vertices[edges[:, 1]], axis=1)
    n = len(mesh.vertices)
    return sparse.csr_array((lengths, (edges[:, 0], edges[:, 1])), shape=(n, n))


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
        [(k, 3 + k, (k + 1) % 3) for k in range(3)]
        + [((k + 1) % 3, 3 + k, 3 + (k + 1) % 3) for k in range(3)]
    )
    return painted(mesh, mesh.vertices[corners], faces, colours[faces])


def _corner_colours(mesh: Mesh, face: int) -> FloatArray:
    return look_up_colours(mesh, np.full(3, face), np.eye(3))
