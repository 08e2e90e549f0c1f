"""Collapsing short edges: fewer vertices, evenly spread, close to the surface.

Many edges are collapsed in one round, the shortest of their neighbourhoods, far enough apart not to
touch one another's triangles; a new vertex minimises the quadric error of Garland and Heckbert (1997).
"""

from dataclasses import dataclass

import numpy as np
from scipy import sparse

from worker.arrays import BoolArray, FloatArray, IntArray
from worker.geometry.areas import face_vectors, unit
from worker.geometry.edges import Edges, find_edges, lengths_of

SHARE = 0.4  # of the edges, the shortest, may collapse in a round
SHUFFLE = 1.3  # how much longer an edge may look by chance
PENALTY = 2.0  # by which the edges at a vertex look longer after each refused collapse
GIVE_UP = 1e3  # penalty from which an edge is left alone
MIDDLE = 1e-2  # pull of the middle of the edge, relative to the quadric


@dataclass(eq=False)
class _Surface:
    """What the rounds change."""

    vertices: FloatArray  # (n, 3)
    faces: IntArray  # (m, 3)
    quadrics: FloatArray  # (n, 3, 4): the normal equations of the squared distance to the planes around
    penalties: FloatArray  # (n,), 1 or more


def collapse_short_edges(
    vertices: FloatArray, faces: IntArray, n_vertices: int, longest: float = np.inf, least: float = 0.0
) -> tuple[FloatArray, IntArray]:
    """Collapse short edges until few enough vertices are left.

    The topology stays (link condition of Dey et al. 1999), no triangle turns over, boundaries keep their
    line.

    Parameters
    ----------
    vertices : (n, 3) array
    faces : (m, 3) array
    n_vertices : int
        How many vertices to keep. More are kept where the topology does not allow so few.
    longest : float
        Edges over this length stay.
    least : float
        The share of the vertices that a round must remove to be followed by another.

    Returns
    -------
    vertices : (n', 3) array
    faces : (m', 3) array
    """
    quadrics = _quadrics(vertices, faces)
    surface = _Surface(vertices.copy(), faces, quadrics, np.ones(len(vertices)))
    while len(surface.vertices) > n_vertices:
        edges = find_edges(surface.faces)
        chosen = _choose(surface, edges, len(surface.vertices) - n_vertices, longest)
        if len(chosen) <= least * len(surface.vertices):
            break
        _collapse(surface, edges.ends[chosen])
    return surface.vertices, surface.faces


def _quadrics(vertices: FloatArray, faces: IntArray) -> FloatArray:
    """Sum at each vertex the squared distances to the planes of its faces and through its boundary edges."""
    vectors = face_vectors(vertices, faces)
    normals = unit(vectors)
    edges = find_edges(faces)
    quadrics = np.zeros((len(vertices), 3, 4))
    areas = np.linalg.norm(vectors, axis=1)
    _add_planes(quadrics, faces, vertices[faces[:, 0]], normals, areas)
    face, corner = np.nonzero(edges.n_faces[edges.of_faces] == 1)
    start, end = faces[face, corner], faces[face, (corner + 1) % 3]
    along = vertices[end] - vertices[start]
    across = unit(np.cross(along, normals[face]))
    _add_planes(quadrics, np.column_stack([start, end]), vertices[start], across, np.sum(along**2, axis=1))
    return quadrics


def _add_planes(
    quadrics: FloatArray, owners: IntArray, points: FloatArray, normals: FloatArray, weights: FloatArray
) -> None:
    offsets = np.sum(normals * points, axis=1)  # n·x = offset on the plane
    rows = np.concatenate(
        [normals[:, :, None] * normals[:, None, :], (offsets[:, None] * normals)[:, :, None]], 2
    )
    rows *= weights[:, None, None]  # (p, 3, 4)
    for column in owners.T:
        np.add.at(quadrics, column, rows)


def _choose(surface: _Surface, edges: Edges, most: int, longest: float) -> IntArray:
    """Pick the shortest edges that are alone in their neighbourhood and may collapse."""
    worst = surface.penalties[edges.ends].max(axis=1)
    lengths = lengths_of(surface.vertices, edges)
    # Where lengths are equal or rise along the surface, few edges would be shorter than all around them.
    shuffle = np.random.default_rng(len(lengths)).uniform(1.0, SHUFFLE, len(lengths))
    costs = np.where((worst > GIVE_UP) | (lengths > longest), np.inf, lengths * worst * shuffle)
    shortest = np.argsort(costs, kind="stable")[: max(1, int(SHARE * len(costs)))]
    shortest = shortest[np.isfinite(costs[shortest])]
    chosen = shortest[_alone(edges.ends, edges.ends[shortest], len(surface.vertices))]
    keeps = _keeps_topology(surface, edges, chosen)
    surface.penalties[edges.ends[chosen[~keeps]]] *= PENALTY
    if keeps.any() or len(chosen) == 0:
        return np.asarray(chosen[keeps][:most])
    return _choose(surface, edges, most, longest)


def _alone(ends: IntArray, candidates: IntArray, n_vertices: int) -> BoolArray:
    """Tell which candidates (sorted, best first) no better one touches, nor touches a neighbour of."""
    ranks = np.arange(len(candidates))
    best = np.full(n_vertices, len(candidates))
    np.minimum.at(best, candidates, ranks[:, None])
    around = best.copy()
    np.minimum.at(around, ends[:, 0], best[ends[:, 1]])
    np.minimum.at(around, ends[:, 1], best[ends[:, 0]])
    return np.asarray((around[candidates] == ranks[:, None]).all(axis=1))


def _keeps_topology(surface: _Surface, edges: Edges, chosen: IntArray) -> BoolArray:
    """Check the link condition: the ends share as many neighbours as the edge has faces.

    Tetrahedra and lone triangles meet it as well, and would vanish.
    """
    n = len(surface.vertices)
    ends = edges.ends
    ones = np.ones(2 * len(ends), dtype=np.int32)
    rows, columns = np.concatenate([ends, ends[:, ::-1]]).T
    adjacent = sparse.csr_array((ones, (rows, columns)), shape=(n, n))
    start, end = ends[chosen].T
    common = adjacent[start].multiply(adjacent[end]).astype(bool).astype(np.int32)
    shared = np.asarray(common.sum(axis=1)).ravel()
    tetrahedron = common @ (np.bincount(ends.ravel(), minlength=n) == 3) > 1
    alone = np.zeros(len(ends), dtype=bool)
    alone[edges.of_faces[(edges.n_faces[edges.of_faces] == 1).all(axis=1)]] = True
    boundary = np.zeros(n, dtype=bool)
    boundary[ends[edges.n_faces == 1]] = True
    pinches = boundary[start] & boundary[end] & (edges.n_faces[chosen] > 1)
    return np.asarray((shared == edges.n_faces[chosen]) & ~pinches & ~tetrahedron & ~alone[chosen])


def _collapse(surface: _Surface, pairs: IntArray) -> None:
    """Collapse edges, given by their ends (c, 2), but for those that would turn a triangle over."""
    targets = _positions(surface, pairs)
    turns = _turns_over(surface, pairs, targets)
    surface.penalties[pairs[turns]] *= PENALTY
    pairs, targets = pairs[~turns], targets[~turns]
    kept, gone = pairs.T
    surface.vertices[kept] = targets
    surface.quadrics[kept] += surface.quadrics[gone]
    new = np.arange(len(surface.vertices))
    new[gone] = kept
    faces = new[surface.faces]
    whole = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
    _compact(surface, faces[whole])


def _positions(surface: _Surface, pairs: IntArray) -> FloatArray:
    """Minimise the quadric error, with a slight pull to the middle that settles flat places."""
    quadrics = surface.quadrics[pairs].sum(axis=1)  # (c, 3, 4)
    middles = surface.vertices[pairs].mean(axis=1)  # (c, 3)
    matrices, sides = quadrics[:, :, :3], quadrics[:, :, 3]
    pull = MIDDLE * np.trace(matrices, axis1=1, axis2=2) + np.finfo(float).tiny
    matrices = matrices + pull[:, None, None] * np.eye(3)
    sides = sides + pull[:, None] * middles
    return np.asarray(np.linalg.solve(matrices, sides[:, :, None])[:, :, 0])


def _turns_over(surface: _Surface, pairs: IntArray, targets: FloatArray) -> BoolArray:
    """Tell which collapses would turn a remaining triangle by more than about 80°."""
    owners = np.full(len(surface.vertices), -1)
    owners[pairs] = np.arange(len(pairs))[:, None]
    corner_owners = owners[surface.faces]  # (m, 3)
    moved = np.count_nonzero(corner_owners >= 0, axis=1) == 1
    faces, face_owners = surface.faces[moved], corner_owners[moved].max(axis=1)
    before = face_vectors(surface.vertices, faces)
    vertices = surface.vertices.copy()
    vertices[pairs] = targets[:, None, :]
    after = face_vectors(vertices, faces)
    cosines = np.sum(unit(before) * unit(after), axis=1)
    flat = ~before.any(axis=1)  # a triangle without area cannot turn over
    turns = np.zeros(len(pairs), dtype=bool)
    turns[face_owners[(cosines < 0.2) & ~flat]] = True
    return turns


def _compact(surface: _Surface, faces: IntArray) -> None:
    """Drop the vertices that no face names any more."""
    used = np.unique(faces)
    new = np.full(len(surface.vertices), -1)
    new[used] = np.arange(len(used))
    surface.faces = new[faces]
    surface.vertices = surface.vertices[used]
    surface.quadrics = surface.quadrics[used]
    surface.penalties = surface.penalties[used]
