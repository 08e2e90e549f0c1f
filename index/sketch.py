"""Sketch: codes of all rows, by which most are ruled out without being read.

Two codings, one after the other: few groups of many numbers each, in boxes of near rows, so that all rows are
looked at quickly; more groups of those that are left.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from index.arrays import ByteArray, PositionArray, RowArray
from index.centres import Centres
from index.coding import Coding
from index.compiled import compiled
from index.layout import Layout
from index.ordering import by_halves

BOX = 128  # rows in a box
COARSE = 16  # groups of the first coding
FINE = 48  # groups of the second,
MERGED = 6  # or numbers of a wide row to one of them
PIECE = 16_384  # rows coded at once
SPARE = 1.1  # room for more boxes, relative to what is needed


class Sketch:
    """Codes of the rows of a method's index, by position.

    Parameters
    ----------
    coarse, fine : Coding
    boxes : (n, g, r) array
        Coarse codes of each box's rows; room for more boxes included.
    codes : (n r, f) array
        Fine codes of each row.
    lows, highs : (g, n) arrays
        Least and greatest coarse code in each box; 255 and 0 where there is no row.
    size : int
        Rows that are there.
    """

    def __init__(
        self,
        *,
        coarse: Coding,
        fine: Coding,
        boxes: ByteArray,
        codes: ByteArray,
        lows: ByteArray,
        highs: ByteArray,
        size: int,
    ) -> None:
        self.coarse = coarse
        self.fine = fine
        self.boxes = boxes
        self.codes = codes
        self.lows = lows
        self.highs = highs
        self.size = size
        self._centres: Centres | None = None  # made when it is first asked for

    @classmethod
    def learn(cls, rows: RowArray, layout: Layout) -> tuple["Sketch", PositionArray]:
        """Return a sketch of rows (n, width) in an order of its own, and that order."""
        sketch = cls.empty(
            Coding.learn(rows, layout, min(layout.width, COARSE)),
            Coding.learn(rows, layout, min(layout.width, max(FINE, layout.width // MERGED))),
        )
        coarse = sketch.coarse.codes(rows)
        order = by_halves(coarse, sketch.coarse.counts, BOX)
        sketch._put(0, coarse, order)
        for start in range(0, len(order), PIECE):
            some = order[start : start + PIECE]
            sketch.codes[start : start + len(some)] = sketch.fine.codes(rows[some])
        return sketch, order

    @classmethod
    def empty(cls, coarse: Coding, fine: Coding) -> "Sketch":
        """Return a sketch without rows."""
        groups = coarse.merges.count
        return cls(
            coarse=coarse,
            fine=fine,
            boxes=np.empty((0, groups, BOX), np.uint8),
            codes=np.empty((0, fine.merges.count), np.uint8),
            lows=np.empty((groups, 0), np.uint8),
            highs=np.empty((groups, 0), np.uint8),
            size=0,
        )

    def append(self, rows: RowArray) -> None:
        """Add rows (m, width) at the next positions."""
        start = self.size
        self._put(start, self.coarse.codes(rows), np.arange(len(rows)))
        self.codes[start : self.size] = self.fine.codes(rows)

    @property
    def n_boxes(self) -> int:
        """How many boxes hold a row."""
        return -(-self.size // BOX)

    @property
    def centres(self) -> Centres:
        """The middles of the boxes."""
        if self._centres is None:
            lows, highs = self.lows[:, : self.n_boxes].T, self.highs[:, : self.n_boxes].T
            middles = (lows.astype(np.float64) + highs) / 2
            self._centres = Centres((middles * self.coarse.counts).astype(np.float32))
        return self._centres

    def arrays(self) -> dict[str, npt.NDArray[Any]]:
        """Return all that `restored` needs."""
        return {
            **self.coarse.arrays("coarse"),
            **self.fine.arrays("fine"),
            "boxes": self.boxes,
            "codes": self.codes,
            "lows": self.lows,
            "highs": self.highs,
            "size": np.array(self.size),
        }

    @classmethod
    def restored(cls, layout: Layout, arrays: Mapping[str, npt.NDArray[Any]]) -> "Sketch":
        """Return the sketch that gave these arrays."""
        return cls(
            coarse=Coding.restored(layout, arrays, "coarse"),
            fine=Coding.restored(layout, arrays, "fine"),
            boxes=arrays["boxes"],
            codes=arrays["codes"],
            lows=arrays["lows"],
            highs=arrays["highs"],
            size=int(arrays["size"]),
        )

    def _put(self, start: int, codes: ByteArray, order: PositionArray) -> None:
        self._reserve(start + len(order))
        _fill(codes, order, start, self.boxes, self.lows, self.highs)
        self.size = start + len(order)
        self._centres = None

    def _reserve(self, n_rows: int) -> None:
        room, needed = len(self.boxes), -(-n_rows // BOX)
        if needed > room:
            more = max(needed, int(SPARE * room)) - room
            self.boxes = np.pad(self.boxes, ((0, more), (0, 0), (0, 0)))
            self.codes = np.pad(self.codes, ((0, more * BOX), (0, 0)))
            self.lows = np.pad(self.lows, ((0, 0), (0, more)), constant_values=255)
            self.highs = np.pad(self.highs, ((0, 0), (0, more)))


@compiled
def _fill(
    codes: ByteArray,
    order: PositionArray,
    start: int,
    boxes: ByteArray,
    lows: ByteArray,
    highs: ByteArray,
) -> None:
    """Put codes (m, g), in some order, into boxes from a position on; widen lows and highs."""
    size = boxes.shape[2]
    for i in range(len(order)):
        box, place = (start + i) // size, (start + i) % size
        for g in range(codes.shape[1]):
            code = codes[order[i], g]
            boxes[box, g, place] = code
            lows[g, box] = min(lows[g, box], code)
            highs[g, box] = max(highs[g, box], code)
