"""Intrinsic Delaunay triangulations: the same metric, better triangles.

Only edge lengths count; the points need not lie in space (Bobenko and Springborn 2007; Fisher et al. 2007).
A half-edge has the number 3 f + i: it runs from corner i of face f to corner i + 1.
"""

import numpy as np

from worker.arrays import FloatArray, IntArray
from worker.compiled import compiled
from worker.geometry.edges import stable_order

FLIPS = 50  # for each edge, at most; the mesh is as good as Delaunay long before
TINIEST = float(np.finfo(float).tiny)
SLACK = 1e-12  # an edge is flipped only where its two cotangents sum to less than this below zero


def intrinsic_delaunay(faces: IntArray, lengths: FloatArray) -> tuple[IntArray, FloatArray]:
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
    _flip_all(tails, sides, twins)
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


@compiled
def _flip_all(tails: IntArray, sides: FloatArray, twins: IntArray) -> None:
    """Flip edges (half-edges of length (3 m,) each) until none needs it, in place.

    Those around a flipped edge are looked at again, the last first.
    """
    n = len(tails)
    waits = np.zeros(n, np.bool_)
    waiting = np.empty(n, np.int64)
    n_waiting, n_flips = 0, 0
    for half in range(n - 1, -1, -1):
        if twins[half] > half:
            waits[half] = True
            waiting[n_waiting] = half
            n_waiting += 1
    while n_waiting > 0 and n_flips < FLIPS * n:
        n_waiting -= 1
        half = waiting[n_waiting]
        waits[half] = False
        if not _flip(tails, sides, twins, half):
            continue
        n_flips += 1
        other = twins[half]
        for edge in (_next(half), _next(_next(half)), _next(other), _next(_next(other))):
            first = min(edge, twins[edge])
            if first >= 0 and not waits[first]:
                waits[first] = True
                waiting[n_waiting] = first
                n_waiting += 1


@compiled
def _next(half: int) -> int:
    return half - half % 3 + (half + 1) % 3


@compiled
def _cosine(a: float, b: float, c: float) -> float:
    """Return the cosine of the angle between sides b and c, opposite to a."""
    return max(-1.0, min(1.0, (b * b + c * c - a * a) / max(2.0 * b * c, TINIEST)))


@compiled
def _flip(tails: IntArray, sides: FloatArray, twins: IntArray, half: int) -> bool:  # noqa: C901 - compiled: one loop, plainly
    """Flip an edge in place where its opposite angles sum to more than π; tell whether it was flipped.

    Faces (a, b, c) and (b, a, d) with the edge a b become (c, d, b) and (d, c, a).
    """
    other = twins[half]
    if other < 0 or half // 3 == other // 3:
        return False
    bc, ad = _next(half), _next(other)
    ca, db = _next(bc), _next(ad)
    length, length_bc, length_ca, length_ad, length_db = (
        sides[half],
        sides[bc],
        sides[ca],
        sides[ad],
        sides[db],
    )
    at_c, at_d = _cosine(length, length_bc, length_ca), _cosine(length, length_ad, length_db)
    # The sine of the sum is negative where the sum is over π.
    if np.sqrt(1.0 - at_c * at_c) * at_d + at_c * np.sqrt(1.0 - at_d * at_d) >= -SLACK:
        return False
    at_a, at_a_too = _cosine(length_bc, length, length_ca), _cosine(length_db, length, length_ad)
    across = at_a * at_a_too - np.sqrt(1.0 - at_a * at_a) * np.sqrt(1.0 - at_a_too * at_a_too)
    square = length_ca * length_ca + length_ad * length_ad - 2.0 * length_ca * length_ad * across
    diagonal = np.sqrt(max(square, 0.0))
    if not _makes_triangle(diagonal, length_bc, length_db):
        return False
    if not _makes_triangle(diagonal, length_ca, length_ad):
        return False
    outer = twins[db], twins[bc], twins[ca], twins[ad]
    corners = tails[db], tails[bc], tails[ca], tails[ad]  # d, b, c, a
    lengths = length_db, length_bc, length_ca, length_ad
    for k, slot in enumerate((bc, ca, ad, db)):
        twin = outer[k]
        if twin == db:
            twin = bc
        elif twin == bc:
            twin = ca
        elif twin == ca:
            twin = ad
        elif twin == ad:
            twin = db
        tails[slot], sides[slot], twins[slot] = corners[k], lengths[k], twin
    for slot in (bc, ca, ad, db):
        if twins[slot] >= 0:
            twins[twins[slot]] = slot
    tails[half], tails[other] = corners[2], corners[0]
    sides[half] = sides[other] = diagonal
    return True


@compiled
def _makes_triangle(a: float, b: float, c: float) -> bool:
    """Tell whether three lengths make a triangle that is not degenerate."""
    return a + b + c > 2.0 * max(a, b, c) * (1.0 + 1e-12)
