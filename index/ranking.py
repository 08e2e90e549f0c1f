"""Ranking: the exact k nearest, proven without reading most rows.

1. The sketch gives rows that are likely to be near. The k-th least of their exact distances is a limit: what
   is farther is not among the k nearest.
2. By bounds from below (see `index.bounds`) the sketch rules out most boxes of rows, and most rows of the
   others.
3. Of the rows that are left, those with the least bounds are compared exactly, which lowers the limit; then
   the rest within it.

A bound never exceeds the distance, and rows that equal the limit are kept: the answer is that of comparing
all. Equal distances are ordered by id, ascending.
"""

from collections.abc import Collection

import numpy as np

from index.arrays import DoubleArray, PositionArray, RowArray
from index.candidates import MARGIN, Candidates
from index.distances import distances
from index.methods import Method
from index.sketch import Sketch
from index.vectors import Vectors
from index.watch import tell_compared

FIRST = 4  # times as many rows as are wanted give the first limit
SECOND = 16  # times as many give the second, where more are left

Ranked = list[tuple[str, float]]


def rank(
    vectors: Vectors,
    query: RowArray,
    limit: int,
    exclude: Collection[str] = (),
    method: Method | None = None,
) -> Ranked:
    """Return the nearest shapes, nearest first.

    Parameters
    ----------
    vectors : Vectors
        What is searched.
    query : (width,) array
        See `Layout.join`.
    limit : int
        How many at most.
    exclude : collection of str
        Ids that are not wanted.
    method : Method, optional
        The layout's own, or with other weights.

    Returns
    -------
    list of (id, distance)
        As comparing all of them would give.
    """
    hidden = vectors.positions(exclude)
    wanted = min(limit, len(vectors) - hidden.size)
    if wanted <= 0:
        return []
    search = _Search(vectors, query, wanted, hidden, method or vectors.layout.method)
    found = search.best(vectors.here) if vectors.sketch is None else search.certified(vectors.sketch)
    tell_compared(search.method.name, search.compared, len(vectors), search.escalated)
    return found


class _Search:
    """One query on its way through the steps above."""

    def __init__(
        self, vectors: Vectors, query: RowArray, wanted: int, hidden: PositionArray, method: Method
    ) -> None:
        self.vectors = vectors
        self.query = query
        self.wanted = wanted
        self.hidden = hidden
        self.method = method
        self.compared = 0  # rows, exactly
        self.escalated = False  # whether the first limits left too many

    def certified(self, sketch: Sketch) -> Ranked:
        candidates = Candidates(sketch, self.query, self.method, self.vectors.largest)
        enough = self.wanted + self.hidden.size
        limit = self.limit(candidates.by_centres(FIRST * enough))
        limit = min(limit, self.limit(candidates.by_rows(limit, FIRST * enough)))
        positions, bounds = candidates.within(limit)
        if len(positions) > 2 * SECOND * enough:
            self.escalated = True
            least = np.argpartition(bounds, SECOND * enough)[: SECOND * enough]
            limit = min(limit, self.limit(positions[least]))
            positions = positions[bounds <= limit * (1.0 + MARGIN)]
        return self.best(positions)

    def limit(self, positions: PositionArray) -> float:
        """Return a distance that is exceeded by none of the nearest."""
        found = self.distances(self.open(positions))
        if len(found) < self.wanted:
            return np.inf
        return float(np.partition(found, self.wanted - 1)[self.wanted - 1])

    def best(self, positions: PositionArray) -> Ranked:
        """Return the nearest of these rows."""
        positions = self.open(positions)
        found = self.distances(positions)
        worst = np.partition(found, self.wanted - 1)[self.wanted - 1]
        near = np.flatnonzero(found <= worst)  # ties with the last one too
        ids = self.vectors.ids
        ranked = sorted((float(found[i]), ids[positions[i]]) for i in near)
        return [(shape_id, distance) for distance, shape_id in ranked[: self.wanted]]

    def open(self, positions: PositionArray) -> PositionArray:
        """Leave out what was removed or is not wanted."""
        positions = self.vectors.only_here(positions)
        return positions[~np.isin(positions, self.hidden)] if self.hidden.size else positions

    def distances(self, positions: PositionArray) -> DoubleArray:
        self.compared += len(positions)
        return distances(self.vectors.rows, positions, self.query, self.vectors.layout, self.method)
