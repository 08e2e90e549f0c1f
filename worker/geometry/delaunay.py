"""Intrinsic Delaunay triangulations: the same metric, better triangles.

Only edge lengths count; the points need not lie in space (Bobenko and Springborn 2007; Fisher et al. 2007).
A half-edge has the number 3 f + i: it runs from corner i of face f to corner i + 1.
"""

import numpy as np

from worker.arrays import BoolArray, FloatArray, IntArray
from worker.geometry.edges import stable_order

ROUNDS = 200  # of flips; the mesh is as good as Delaunay long before
SLACK = 1e-12  # an edge is flipped only where its two cotangents sum to less than this below zero


def intrinsic_delaunay(
    faces: IntArray, lengths: FloatArray, rounds: int = ROUNDS
) -> tuple[IntArray, FloatArray]:
    """Flip edges until their cotangent weights are not negative.

    Edges at a boundary, between more than two faces, or between two faces of opposite orientation stay.

    Parameters
    ----------
    faces : (m, 3) array
        Indices of vertices.
    lengths : (m, 3) array
        Column i is the length from corner i to corner i + 1.

    Returns
    -------
    faces : (m, 3) array
        An edge may now join a vertex to itself, and two edges the same vertices.
    lengths : (m, 3) array
    """
    tails, sides, twins = faces.ravel().copy(), lengths.ravel().copy(), _twins(faces)
    for _ in range(rounds):
        edges = _independent(_not_delaunay(sides, twins), twins)
        if not _flip(tails, sides, twins, edges):
            break
    return tails.reshape(-1, 3), sides.reshape(-1, 3)


def _twins(faces: IntArray) -> IntArray:
    """Pair the half-edges of edges with exactly two faces, running opposite ways; −1 elsewhere."""
    tails, heads = faces.ravel(), faces[:, [1, 2, 0]].ravel()
    n = int(faces.max(initial=0)) + 1
    keys = np.minimum(tails, heads) * n + np.maximum(tails, heads)
    order = stable_order(keys)
    starts = np.flatnonzero(np.r_[True, np.diff(keys[order]) != 0])
    counts = np.diff(np.r_[starts, len(order)])
    first, second = order[starts[counts == 2]], order[starts[counts == 2] + 1]
    opposite = (tails[first] == heads[second]) & (first // 3 != second // 3)
    twins = np.full(len(tails), -1)
    twins[first[opposite]], twins[second[opposite]] = second[opposite], first[opposite]
    return twins


def _next(half: IntArray) -> IntArray:
    return half - half % 3 + (half + 1) % 3


def _cosine_law(a: FloatArray, b: FloatArray, c: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return cosine and sine of the angle between sides b and c, opposite to a."""
    cosine = np.clip((b**2 + c**2 - a**2) / np.maximum(2 * b * c, np.finfo(float).tiny), -1.0, 1.0)
    return cosine, np.sqrt(1.0 - cosine**2)


def _not_delaunay(sides: FloatArray, twins: IntArray) -> IntArray:
    """Return one half of each edge whose opposite angles sum to more than π, the worst first."""
    a, b, c = sides.reshape(-1, 3).T  # (m,) each
    cosine, sine = (
        np.stack(of_corners, axis=1).ravel()
        for of_corners in zip(_cosine_law(a, b, c), _cosine_law(b, c, a), _cosine_law(c, a, b), strict=True)
    )  # opposite to each half-edge
    number = np.arange(len(twins))
    half = np.flatnonzero((twins > number) & (twins // 3 != number // 3))
    other = twins[half]
    # The sine of the sum is negative where the sum is over π.
    sine_of_sum = sine[half] * cosine[other] + cosine[half] * sine[other]
    worst = np.flatnonzero(sine_of_sum < -SLACK)
    return np.asarray(half[worst[np.argsort(sine_of_sum[worst], kind="stable")]])


def _independent(half: IntArray, twins: IntArray) -> IntArray:
    """Keep edges of which no face is shared by a better one."""
    ranks = np.arange(len(half))
    best = np.full(len(twins) // 3, len(half))
    both = np.column_stack([half // 3, twins[half] // 3])
    np.minimum.at(best, both, ranks[:, None])
    return np.asarray(half[(best[both] == ranks[:, None]).all(axis=1)])


def _flip(tails: IntArray, sides: FloatArray, twins: IntArray, half: IntArray) -> bool:
    """Flip edges that share no face, in place; tell whether any was flipped.

    Faces (a, b, c) and (b, a, d) with the edge a b become (c, d, b) and (d, c, a).
    """
    other = twins[half]
    bc, ca, ad, db = _next(half), _next(_next(half)), _next(other), _next(_next(other))
    diagonal = _other_diagonal(sides[half], sides[ca], sides[bc], sides[ad], sides[db])
    keep = _makes_triangles(diagonal, sides[bc], sides[db]) & _makes_triangles(diagonal, sides[ca], sides[ad])
    half, other, bc, ca, ad, db = (x[keep] for x in (half, other, bc, ca, ad, db))
    c, d = tails[ca], tails[db]
    b, a = tails[bc], tails[ad]
    outer = np.stack([twins[db], twins[bc], twins[ca], twins[ad]])
    lengths = np.stack([sides[db], sides[bc], sides[ca], sides[ad]])
    own = np.stack([_next(half), _next(_next(half)), _next(other), _next(_next(other))])
    moved = np.arange(len(twins) + 1)  # the last entry keeps −1, for boundaries
    moved[np.stack([db, bc, ca, ad])], moved[-1] = own, -1
    outer = moved[outer]
    for k, tail in enumerate((d, b, c, a)):
        tails[own[k]], sides[own[k]], twins[own[k]] = tail, lengths[k], outer[k]
    tails[half], tails[other] = c, d
    sides[half] = sides[other] = diagonal[keep]
    inner = outer >= 0
    twins[outer[inner]] = own[inner]
    return len(half) > 0


def _other_diagonal(
    ab: FloatArray, ca: FloatArray, bc: FloatArray, ad: FloatArray, db: FloatArray
) -> FloatArray:
    """Lay two triangles with the common side a b in the plane; return the distance from c to d."""
    cosine, sine = _cosine_law(bc, ab, ca)  # at a, in (a, b, c)
    cosine_2, sine_2 = _cosine_law(db, ab, ad)  # at a, in (b, a, d)
    across = cosine * cosine_2 - sine * sine_2  # cosine of the sum
    return np.asarray(np.sqrt(np.maximum(ca**2 + ad**2 - 2 * ca * ad * across, 0.0)))


def _makes_triangles(a: FloatArray, b: FloatArray, c: FloatArray) -> BoolArray:
    """Tell where three lengths make a triangle that is not degenerate."""
    longest = np.maximum(np.maximum(a, b), c)
    return np.asarray(a + b + c > 2 * longest * (1 + 1e-12))
