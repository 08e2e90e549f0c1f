"""Vectors: the rows of a method's index under their ids, with a sketch of them where they are many."""

from collections.abc import Collection, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from index.arrays import PositionArray, RowArray
from index.distances import levels_of
from index.layout import Layout
from index.reordering import reorder
from index.sketch import Sketch

SKETCHED = 4096  # rows from which a sketch pays
STALE = 0.25  # share of rows, removed or out of order, from which the order is made anew
SPARE = 1.1  # room for more rows, relative to what is needed
PIECE = 16_384  # rows looked at at once
GONE = ""  # id of a removed row


class Vectors:
    """Rows under ids.

    A removed row stays in its place, without an id, until the order is made anew. A writer must be alone:
    see `index.locks`.

    Parameters
    ----------
    layout : Layout
        Of every row.
    """

    def __init__(self, layout: Layout) -> None:
        self.layout = layout
        self.sketch: Sketch | None = None
        self.largest = 0.0  # L1 norm of any row so far, in whole units: bounds the rounding of sums
        self._rows: RowArray = np.empty((0, layout.width), layout.dtype)  # with room for more
        self._here = np.empty(0, np.bool_)  # the same length
        self._ids: list[str] = []
        self._positions: dict[str, int] = {}
        self._ordered = 0  # rows that are in the order of the sketch

    def __len__(self) -> int:
        return len(self._positions)

    @property
    def ids(self) -> Sequence[str]:
        """The ids, by position; GONE where a row was removed."""
        return self._ids

    @property
    def rows(self) -> RowArray:
        """The rows, by position, removed ones included."""
        return self._rows[: len(self._ids)]

    @property
    def here(self) -> PositionArray:
        """The positions of all that are not removed."""
        return np.flatnonzero(self._here[: len(self._ids)])

    def only_here(self, positions: PositionArray) -> PositionArray:
        """Return those positions whose row is not removed."""
        return positions[self._here[positions]]

    def positions(self, ids: Collection[str]) -> PositionArray:
        """Return where those of `ids` are that are here."""
        return np.array([self._positions[i] for i in set(ids) if i in self._positions], dtype=np.int64)

    def put(self, ids: Sequence[str], rows: RowArray) -> None:
        """Add rows (m, width) under distinct ids; what was known under them is removed."""
        self.remove(ids)
        start, end = len(self._ids), len(self._ids) + len(ids)
        self._reserve(end)
        self._rows[start:end] = rows
        self._here[start:end] = True
        self._ids.extend(ids)
        self._positions.update(zip(ids, range(start, end), strict=True))
        self._measure(rows)
        if self.sketch is not None:
            self.sketch.append(rows)

    def remove(self, ids: Collection[str]) -> None:
        """Forget rows; unknown ids are fine."""
        for shape_id in ids:
            position = self._positions.pop(shape_id, None)
            if position is not None:
                self._here[position] = False
                self._ids[position] = GONE

    def settle(self) -> None:
        """Forget removed rows and put the others in order, where a good part is removed or out of order."""
        removed = len(self._ids) - len(self)
        if len(self._ids) - self._ordered + removed <= STALE * len(self):
            return
        if removed:
            self._take(self.here)
            self.sketch, self._ordered = None, 0
        if len(self) >= SKETCHED:
            self.sketch, order = Sketch.learn(self.rows, self.layout)
            self._take(order)
            self._ordered = len(order)

    def arrays(self) -> dict[str, npt.NDArray[Any]]:
        """Return all that `restored` needs beside the ids; views, not copies."""
        own = {
            "rows": self.rows,
            "largest": np.array(self.largest),
            "ordered": np.array(self._ordered),
        }
        return own if self.sketch is None else own | self.sketch.arrays()

    @classmethod
    def restored(cls, layout: Layout, ids: list[str], arrays: dict[str, npt.NDArray[Any]]) -> "Vectors":
        """Return the vectors that gave these ids and arrays; the arrays become theirs."""
        vectors = cls(layout)
        vectors._rows = arrays["rows"]
        vectors._ids = ids
        vectors._positions = {shape_id: position for position, shape_id in enumerate(ids) if shape_id != GONE}
        vectors._here = np.array([shape_id != GONE for shape_id in ids], np.bool_)
        if "boxes" in arrays:
            vectors.sketch = Sketch.restored(layout, arrays)
        vectors._ordered = int(arrays["ordered"])
        vectors.largest = float(arrays["largest"])
        return vectors

    def _measure(self, rows: RowArray) -> None:
        for first in range(0, len(rows), PIECE):
            norms = np.abs(levels_of(rows[first : first + PIECE], self.layout)).sum(axis=1)
            self.largest = max(self.largest, float(norms.max()))

    def _take(self, order: PositionArray) -> None:
        """Keep these rows alone, in this order."""
        reorder(self._rows, order)
        self._ids = [self._ids[position] for position in order.tolist()]
        self._here[: len(order)] = True
        self._positions = {shape_id: position for position, shape_id in enumerate(self._ids)}

    def _reserve(self, n_rows: int) -> None:
        if n_rows > len(self._rows):
            room = max(n_rows, int(SPARE * len(self._rows)))
            self._rows.resize((room, self.layout.width), refcheck=False)  # in place where the system can
            self._here.resize(room, refcheck=False)
