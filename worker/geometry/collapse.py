"""Collapsing short edges: fewer vertices, evenly spread, close to the surface.

Many edges are collapsed in one round, the shortest of their neighbourhoods, far enough apart not to
touch one another's triangles; a new vertex minimises the quadric error of Garland and Heckbert (1997).
"""

from dataclasses import dataclass

import numpy as np

from worker.arrays import BoolArray, FloatArray, IntArray
from worker.geometry.areas import face_vectors, norms, unit
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
    face, corner = np.nonzero(edges.n_faces[edges.of_faces] == 1)
    start, end = faces[face, corner], faces[face, (corner + 1) % 3]
    along = vertices[end] - vertices[start]
    across = unit(np.cross(along, normals[face]))
    owners = [*faces.T, start, end]
    planes = [_planes(vertices[faces[:, 0]], normals, norms(vectors))] * 3
    planes += [_planes(vertices[start], across, np.sum(along**2, axis=1))] * 2
    return _sums(np.concatenate(owners), np.concatenate(planes, axis=1), len(vertices))


def _planes(points: FloatArray, normals: FloatArray, weights: FloatArray) -> FloatArray:
    """Return the entries 11, 12, 13, 22, 23, 33, 14, 24, 34 of the (3, 4) equations of planes; (9, p)."""
    x, y, z = normals.T
    offsets = np.sum(normals * points, axis=1)  # n·x = offset on the plane
    entries = [x * x, x * y, x * z, y * y, y * z, z * z, offsets * x, offsets * y, offsets * z]
    return np.stack(entries) * weights


def _sums(owners: IntArray, planes: FloatArray, n_vertices: int) -> FloatArray:
    """Add up the equations of the planes that each vertex owns; (n, 3, 4)."""
    sums = [np.bincount(owners, entry, n_vertices) for entry in planes]
    places = [0, 1, 2, 6, 1, 3, 4, 7, 2, 4, 5, 8]  # of the entries, row by row
    rows = np.stack([sums[place] for place in places], axis=1)  # (n, 12)
    return rows.reshape(-1, 3, 4).astype(np.float64)


def _choose(surface: _Surface, edges: Edges, most: int, longest: float) -> IntArray:
    """Pick the shortest edges that are alone in their neighbourhood and may collapse."""
    worst = np.maximum(*surface.penalties[edges.ends.T])
    lengths = lengths_of(surface.vertices, edges)
    # Where lengths are equal or rise along the surface, few edges would be shorter than all around them.
    shuffle = np.random.default_rng(len(lengths)).uniform(1.0, SHUFFLE, len(lengths))
    costs = np.where((worst > GIVE_UP) | (lengths > longest), np.inf, lengths * worst * shuffle)
    shortest = _ascending(costs)[: max(1, int(SHARE * len(costs)))]
    shortest = shortest[np.isfinite(costs[shortest])]
    chosen = shortest[_alone(edges.ends, edges.ends[shortest], len(surface.vertices))]
    keeps = _keeps_topology(surface, edges, chosen)
    surface.penalties[edges.ends[chosen[~keeps]]] *= PENALTY
    if keeps.any() or len(chosen) == 0:
        return np.asarray(chosen[keeps][:most])
    return _choose(surface, edges, most, longest)


def _ascending(costs: FloatArray) -> IntArray:
    """Order costs, equal ones as they stand, save infinite ones; ties are rare, stability slow."""
    order = np.argsort(costs)
    ordered = costs[order]
    ties = (ordered[1:] == ordered[:-1]) & np.isfinite(ordered[1:])
    return np.argsort(costs, kind="stable") if ties.any() else order


def _alone(ends: IntArray, candidates: IntArray, n_vertices: int) -> BoolArray:
    """Tell which candidates (sorted, best first) no better one touches, nor touches a neighbour of."""
    ranks = np.arange(len(candidates))
    best = np.full(n_vertices, len(candidates))
    best[candidates[::-1].ravel()] = np.repeat(ranks[::-1], 2)  # of several, the last one stays
    at_start, at_end = best[ends[:, 0]], best[ends[:, 1]]
    beaten = np.zeros(n_vertices, dtype=np.bool_)
    beaten[ends[at_end < at_start, 0]] = True
    beaten[ends[at_start < at_end, 1]] = True
    return np.asarray(((best[candidates] == ranks[:, None]) & ~beaten[candidates]).all(axis=1))


def _keeps_topology(surface: _Surface, edges: Edges, chosen: IntArray) -> BoolArray:
    """Check the link condition: the ends share as many neighbours as the edge has faces.

    Tetrahedra and lone triangles meet it as well, and would vanish.
    """
    n = len(surface.vertices)
    ends = edges.ends
    owners, common = _common_neighbours(ends, ends[chosen], n)
    shared = np.bincount(owners, minlength=len(chosen))
    threefold = np.bincount(ends.ravel(), minlength=n) == 3
    tetrahedron = np.bincount(owners[threefold[common]], minlength=len(chosen)) > 1
    alone = np.zeros(len(ends), dtype=bool)
    open_sides = (edges.n_faces == 1)[edges.of_faces.T]  # (3, m)
    alone[edges.of_faces[open_sides[0] & open_sides[1] & open_sides[2]]] = True
    boundary = np.zeros(n, dtype=bool)
    boundary[ends[edges.n_faces == 1]] = True
    pinches = boundary[ends[chosen]].all(axis=1) & (edges.n_faces[chosen] > 1)
    return np.asarray((shared == edges.n_faces[chosen]) & ~pinches & ~tetrahedron & ~alone[chosen])


def _common_neighbours(ends: IntArray, pairs: IntArray, n_vertices: int) -> tuple[IntArray, IntArray]:
    """List the vertices that edges join to both of a pair; pairs (c, 2) share no vertex.

    Returns
    -------
    owners, common : (k,) arrays
        The pair, and the vertex.
    """
    owners = np.full(n_vertices, -1)
    owners[pairs] = np.arange(len(pairs))[:, None]
    at_start, at_end = owners[ends[:, 0]], owners[ends[:, 1]]
    other = at_start != at_end
    from_start, from_end = (at_start >= 0) & other, (at_end >= 0) & other
    keys = np.concatenate(
        [
            at_start[from_start] * n_vertices + ends[from_start, 1],
            at_end[from_end] * n_vertices + ends[from_end, 0],
        ]
    )
    keys.sort()
    both = keys[1:][keys[1:] == keys[:-1]]
    return both // n_vertices, both % n_vertices


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
    a, b, c = faces.T
    _compact(surface, faces[(a != b) & (b != c) & (c != a)])


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
    a, b, c = (corner_owners >= 0).T
    moved = np.flatnonzero((a ^ b ^ c) & ~(a & b & c))  # those with one corner
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
    named = np.zeros(len(surface.vertices), dtype=np.bool_)
    named[faces] = True
    used, new = np.flatnonzero(named), np.cumsum(named) - 1
    surface.faces = new[faces]
    surface.vertices = surface.vertices[used]
    surface.quadrics = surface.quadrics[used]
    surface.penalties = surface.penalties[used]
