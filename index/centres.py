"""Centres: the middles of boxes, of which faiss tells the nearest. The only file that imports it."""

import faiss
import numpy as np

from index.arrays import PositionArray, SingleArray


class Centres:
    """Points searched by L1.

    Parameters
    ----------
    points : (n, g) array
    """

    def __init__(self, points: SingleArray) -> None:
        # Flat alone: SQ8 and PQ variants raise, give wrong answers or abort the process with L1.
        self._flat = faiss.IndexFlat(points.shape[1], faiss.METRIC_L1)
        self._flat.add(np.ascontiguousarray(points))

    def nearest(self, query: SingleArray, count: int) -> PositionArray:
        """Return which points are nearest to a query (g,), at most so many."""
        found: PositionArray = self._flat.search(query[None], min(count, self._flat.ntotal))[1][0]
        return found[found >= 0]  # -1 where a distance is not finite
