"""Vectors: a method's long vectors in faiss. The only file that imports it."""

from collections.abc import Collection, Sequence

import faiss
import numpy as np

from index.arrays import PositionArray, SingleArray
from index.layout import Layout


class Vectors:
    """Shapes' vectors under their ids, searched by L1.

    faiss holds them scaled; what scaling rounds is kept a second time, so that every vector can be
    given back bit for bit. Not safe for a writer beside readers: faiss crashes. See `index.locks`.

    Parameters
    ----------
    layout : Layout
        Of every vector.
    """

    def __init__(self, layout: Layout) -> None:
        self.layout = layout
        # Flat alone: SQ8 and PQ variants raise, give wrong answers or abort the process with L1.
        self._flat = faiss.IndexFlat(layout.width, faiss.METRIC_L1)
        self._unscaled = np.empty((0, layout.rounded.size), dtype=np.float32)  # (capacity, r)
        self._ids: list[str] = []
        self._positions: dict[str, int] = {}
        self.largest_norm = 0.0  # of any scaled vector so far, L1: bounds the rounding of distances

    def __len__(self) -> int:
        return len(self._ids)

    @property
    def ids(self) -> Sequence[str]:
        """The ids, by position."""
        return self._ids

    def positions(self, ids: Collection[str]) -> PositionArray:
        """Return where those of `ids` are that are here."""
        return np.array([self._positions[i] for i in set(ids) if i in self._positions], dtype=np.int64)

    def put(self, ids: Sequence[str], rows: SingleArray) -> None:
        """Add vectors (m, width), not scaled, under distinct ids; known ids get the new ones in place."""
        new = np.array([i not in self._positions for i in ids], dtype=bool)
        old = np.array([self._positions[i] for i in ids if i in self._positions], dtype=np.int64)
        scaled = self.scaled(rows)
        if len(ids):
            norms = np.abs(scaled).sum(axis=1, dtype=np.float64)
            self.largest_norm = max(self.largest_norm, float(norms.max()))
        if old.size:
            self._stored()[old] = scaled[~new]
            self._unscaled[old] = rows[~new][:, self.layout.rounded]
        self._append([i for i in ids if i not in self._positions], rows[new], scaled[new])

    def remove(self, ids: Collection[str]) -> None:
        """Forget vectors; unknown ids are fine."""
        gone = self.positions(ids)
        if not gone.size:
            return
        stays = np.ones(len(self), dtype=bool)
        stays[gone] = False
        self._flat.remove_ids(faiss.IDSelectorBatch(gone))  # keeps the order of the others
        self._unscaled = self._unscaled[: len(stays)][stays]
        self._ids = [i for i, kept in zip(self._ids, stays, strict=True) if kept]
        self._positions = {i: position for position, i in enumerate(self._ids)}

    def scaled(self, rows: SingleArray) -> SingleArray:
        """Return vectors (…, width) as faiss compares them."""
        with np.errstate(over="ignore"):  # what overflows is found by an exact scan
            return rows * self.layout.scales

    def nearest(self, query: SingleArray, count: int) -> tuple[PositionArray, SingleArray]:
        """Return positions and scaled L1 distances, ascending, of the `count` nearest.

        Distances are single precision sums. A position is -1 where faiss found no finite distance.
        """
        sums, positions = self._flat.search(self.scaled(query)[None], count)
        return positions[0], sums[0]

    def within(self, query: SingleArray, radius: float) -> PositionArray:
        """Return the positions of all vectors whose scaled L1 distance is at most `radius`."""
        beyond = float(np.nextafter(np.float32(radius), np.float32(np.inf)))  # faiss takes those below
        positions: PositionArray = self._flat.range_search(self.scaled(query)[None], beyond)[2]
        return positions

    def rows(self, positions: PositionArray) -> SingleArray:
        """Return vectors (m, width) exactly as they were put, not scaled."""
        rows: SingleArray = self._stored()[positions]
        rows[:, self.layout.rounded] = self._unscaled[positions]
        return rows

    def _append(self, ids: Sequence[str], rows: SingleArray, scaled: SingleArray) -> None:
        start, end = len(self), len(self) + len(ids)
        if end > len(self._unscaled):
            larger = np.empty((max(end, 2 * start), self.layout.rounded.size), dtype=np.float32)
            larger[:start] = self._unscaled[:start]
            self._unscaled = larger
        self._unscaled[start:end] = rows[:, self.layout.rounded]
        self._flat.add(np.ascontiguousarray(scaled))
        self._ids.extend(ids)
        self._positions.update(zip(ids, range(start, end), strict=True))

    def _stored(self) -> SingleArray:
        if not self._flat.ntotal:
            return np.empty((0, self.layout.width), dtype=np.float32)
        numbers = faiss.rev_swig_ptr(self._flat.get_xb(), self._flat.ntotal * self.layout.width)
        view: SingleArray = numbers.reshape(-1, self.layout.width)  # faiss's own memory
        return view
