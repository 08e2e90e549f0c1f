"""Ranking: the exact k nearest, proven without comparing all of them.

1. faiss gives candidates by the scaled L1 distance s (see `Layout`).
2. Their distances d are computed exactly, in double precision from the stored numbers.
3. A shape with d no greater than the k-th of them has s within a radius that follows from the relation of
   d and s and from the rounding of single precision. If the candidates reach beyond that radius, nothing
   is missing: the answer is certified.
4. Otherwise faiss gives everything within the radius, and step 2 on that is the answer.

Equal distances are ordered by id, ascending; all shapes with equal distance lie within the radius, so this
holds across the border of the candidates too.
"""

import math
from collections.abc import Collection

import numpy as np

from index.arrays import PositionArray, SingleArray
from index.layout import Layout
from index.methods import Method
from index.vectors import Vectors

_ROUNDING = 2.0**-24  # relative, of one operation in single precision
_SMALLEST = 2.0**-125  # absolute, where single precision runs out of exponents
_LARGEST = float(np.finfo(np.float32).max)
_CHUNK = 256  # rows compared at once: they stay in the processor's cache

Ranked = list[tuple[str, float]]


def rank(
    vectors: Vectors,
    query: SingleArray,
    limit: int,
    exclude: Collection[str] = (),
    method: Method | None = None,
) -> Ranked:
    """Return the nearest shapes, nearest first.

    Parameters
    ----------
    vectors : Vectors
        What is searched.
    query : (width,) float32
        Not scaled; see `Layout.join`.
    limit : int
        How many at most.
    exclude : collection of str
        Ids that are not wanted.
    method : Method, optional
        The layout's own, or with other weights; for the latter all vectors are compared exactly.

    Returns
    -------
    list of (id, distance)
        As comparing all of them would give.
    """
    unwanted = vectors.positions(exclude)
    wanted = min(limit, len(vectors) - unwanted.size)
    if wanted <= 0:
        return []
    search = _Search(vectors, query, wanted, unwanted, method or vectors.layout.method)
    if search.method.blocks != vectors.layout.method.blocks:
        return search.all()
    return search.certified(candidates=4 * wanted + 32 + unwanted.size)


def certain_radius(layout: Layout, distance: float, norms: float) -> float:
    """Return a bound on faiss's s for every vector whose exact distance is at most `distance`.

    Parameters
    ----------
    layout : Layout
        Of both vectors.
    distance : float
        d, in the method's unit.
    norms : float
        L1 norm of the scaled query plus the largest of a scaled vector: numbers are rounded in
        proportion to themselves, not to their differences.
    """
    power, n_blocks = layout.method.power, len(layout.lengths)
    s: float = (distance / layout.unit * n_blocks ** (power - 1)) ** (1.0 / power)
    relative = (layout.width + 32) * _ROUNDING  # of a sum of so many terms, whatever their order
    absolute = 4 * _ROUNDING * norms + layout.width * _SMALLEST
    return (s * (1 + relative) + absolute) / (1 - relative)


class _Search:
    """One query on its way through the steps above."""

    def __init__(
        self, vectors: Vectors, query: SingleArray, wanted: int, unwanted: PositionArray, method: Method
    ) -> None:
        self.vectors = vectors
        self.query = query
        self.wanted = wanted
        self.unwanted = unwanted
        self.method = method

    def certified(self, candidates: int) -> Ranked:
        if candidates >= len(self.vectors):
            return self.all()
        positions, sums = self.vectors.nearest(self.query, candidates)
        if positions.min() < 0:  # numbers too large for single precision
            return self.all()
        best = self.best(positions)
        radius = self.radius(best[-1][1])
        if sums[-1] > radius:
            return best
        return self.best(self.vectors.within(self.query, radius)) if radius < _LARGEST else self.all()

    def all(self) -> Ranked:
        return self.best(np.arange(len(self.vectors)))

    def best(self, positions: PositionArray) -> Ranked:
        positions = positions[~np.isin(positions, self.unwanted)]
        distances = np.concatenate(
            [
                self.vectors.layout.distances(self.vectors.rows(some), self.query, self.method)
                for some in np.array_split(positions, math.ceil(positions.size / _CHUNK))
            ]
        )
        worst = np.partition(distances, self.wanted - 1)[self.wanted - 1]
        near = np.flatnonzero(distances <= worst)  # ties with the last one too
        ids = self.vectors.ids
        ranked = sorted((float(distances[i]), ids[positions[i]]) for i in near)
        return [(shape_id, distance) for distance, shape_id in ranked[: self.wanted]]

    def radius(self, distance: float) -> float:
        own = np.abs(self.vectors.scaled(self.query)).sum(dtype=np.float64)
        return certain_radius(self.vectors.layout, distance, float(own) + self.vectors.largest_norm)
