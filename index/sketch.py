"""Sketch: codes of all rows in boxes of near ones, by which most rows are ruled out without being read."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from index.arrays import ByteArray, PositionArray, RowArray, SingleArray
from index.bounds import box_bounds, least_bounds, row_bounds
from index.centres import Centres
from index.coding import Coding
from index.compiled import compiled
from index.layout import Layout
from index.merging import Merges
from index.methods import Method
from index.ordering import by_halves

BOX = 128  # rows in a box
SEEDS = 16  # boxes in which likely rows are looked for
LOOKED_AT = 16  # groups by which boxes are bounded
SPARE = 1.1  # room for more boxes, relative to what is needed
MARGIN = 1e-5  # relative, by which bounds in single precision may exceed the true ones


class Sketch:
    """Codes of the rows of a method's index, by position.

    Parameters
    ----------
    coding : Coding
    codes : (n, g, r) array
        Of each box's rows; room for more boxes included.
    lows, highs : (g, n) arrays
        Least and greatest code in each box; 255 and 0 where there is no row.
    size : int
        Rows that are there.
    """

    def __init__(
        self, *, coding: Coding, codes: ByteArray, lows: ByteArray, highs: ByteArray, size: int
    ) -> None:
        self.coding = coding
        self.codes = codes
        self.lows = lows
        self.highs = highs
        self.size = size
        self._centres: Centres | None = None  # made when it is first asked for

    @classmethod
    def learn(cls, rows: RowArray, coding: Coding) -> tuple["Sketch", PositionArray]:
        """Return a sketch of rows (n, width) in an order of its own, and that order."""
        codes = coding.codes(rows)
        order = by_halves(codes, coding.counts, BOX)
        sketch = cls.empty(coding)
        sketch._put(0, codes, order)
        return sketch, order

    @classmethod
    def empty(cls, coding: Coding) -> "Sketch":
        """Return a sketch without rows."""
        groups = coding.merges.count
        return cls(
            coding=coding,
            codes=np.empty((0, groups, BOX), np.uint8),
            lows=np.empty((groups, 0), np.uint8),
            highs=np.empty((groups, 0), np.uint8),
            size=0,
        )

    def arrays(self) -> dict[str, npt.NDArray[Any]]:
        """Return all that `restored` needs."""
        merges = self.coding.merges
        return {
            "groups": merges.groups,
            "signs": merges.signs,
            "blocks": merges.blocks,
            "origins": self.coding.origins,
            "steps": self.coding.steps,
            "codes": self.codes,
            "lows": self.lows,
            "highs": self.highs,
            "size": np.array(self.size),
        }

    @classmethod
    def restored(cls, layout: Layout, arrays: Mapping[str, npt.NDArray[Any]]) -> "Sketch":
        """Return the sketch that gave these arrays."""
        merges = Merges(groups=arrays["groups"], signs=arrays["signs"], blocks=arrays["blocks"])
        coding = Coding(layout=layout, merges=merges, origins=arrays["origins"], steps=arrays["steps"])
        boxes = {name: arrays[name] for name in ("codes", "lows", "highs")}
        return cls(coding=coding, size=int(arrays["size"]), **boxes)

    def append(self, rows: RowArray) -> None:
        """Add rows (m, width) at the next positions."""
        self._put(self.size, self.coding.codes(rows), np.arange(len(rows)))

    def candidates(self, query: RowArray, method: Method, largest: float) -> "Candidates":
        """Return what the sketch tells of distances to a query (width,); `largest` as in `Coding.ends`."""
        return Candidates(self, query, method, largest)

    @property
    def centres(self) -> Centres:
        """The middles of the boxes."""
        if self._centres is None:
            full = -(-self.size // BOX)
            middles = (self.lows[:, :full].T.astype(np.float64) + self.highs[:, :full].T) / 2
            self._centres = Centres((middles * self.coding.counts).astype(np.float32))
        return self._centres

    def _put(self, start: int, codes: ByteArray, order: PositionArray) -> None:
        self._reserve(start + len(order))
        fill_boxes(codes, order, start, self.codes, self.lows, self.highs)
        self.size = start + len(order)
        self._centres = None

    def _reserve(self, n_rows: int) -> None:
        room, needed = len(self.codes), -(-n_rows // BOX)
        if needed > room:
            more = ((0, max(needed, int(SPARE * room)) - room),)
            self.codes = np.pad(self.codes, (*more, (0, 0), (0, 0)))
            self.lows = np.pad(self.lows, ((0, 0), *more), constant_values=255)
            self.highs = np.pad(self.highs, ((0, 0), *more))


class Candidates:
    """Rows that may be near one query, by bounds of their distances.

    Parameters as for `Sketch.candidates`.
    """

    def __init__(self, sketch: Sketch, query: RowArray, method: Method, largest: float) -> None:
        coding = sketch.coding
        self._sketch = sketch
        self._query = query
        blocks = coding.merges.blocks
        weights = coding.layout.weights(method)[blocks] * coding.steps**method.power
        ends = coding.ends(query, largest)
        self._question = (*ends, blocks, weights.astype(np.float32), method.power)
        self._boxes = np.empty(sketch.lows.shape[1], np.float32)  # bounds
        box_bounds(sketch.lows, sketch.highs, *self._question, self._boxes)
        self._boxes = self._boxes[: -(-sketch.size // BOX)]

    def by_centres(self, count: int) -> PositionArray:
        """Return positions that are likely to be near: those with the least bounds in the nearest boxes."""
        place = self._sketch.coding.places(self._query[None])[0] * self._sketch.coding.counts
        return self._least_of(self._sketch.centres.nearest(place.astype(np.float32), SEEDS), count)

    def by_bounds(self, count: int) -> PositionArray:
        """Return positions that are likelier: those with the least bounds in the boxes with the least."""
        few = min(SEEDS, len(self._boxes)) - 1
        return self._least_of(np.argpartition(self._boxes, few)[: few + 1], count)

    def look_at_rows(self, limit: float) -> None:
        """Sharpen the bounds of boxes that may hold a row within a distance, by the first of its codes."""
        boxes = np.flatnonzero(self._boxes <= limit * (1.0 + MARGIN))
        bounds = np.empty(len(boxes), np.float32)
        below, above, blocks, weights, power = self._question
        first = [part[:LOOKED_AT] for part in (below, above, blocks, weights)]
        least_bounds(self._sketch.codes, boxes, *first, power, bounds)
        self._boxes[boxes] = np.maximum(self._boxes[boxes], bounds)

    def within(self, limit: float) -> tuple[PositionArray, SingleArray]:
        """Return the positions of all rows that may be within a distance, ascending, and their bounds."""
        above = limit * (1.0 + MARGIN)
        return self._rows(np.flatnonzero(self._boxes <= above), above)

    def _least_of(self, boxes: PositionArray, count: int) -> PositionArray:
        positions, bounds = self._rows(boxes, np.inf)
        if len(positions) <= count:
            return positions
        return positions[np.argpartition(bounds, count)[:count]]

    def _rows(self, boxes: PositionArray, limit: float) -> tuple[PositionArray, SingleArray]:
        positions = np.empty(len(boxes) * BOX, np.int64)
        bounds = np.empty(len(boxes) * BOX, np.float32)
        with np.errstate(over="ignore"):
            single = np.array([limit], np.float32)
        found = row_bounds(self._sketch.codes, boxes, *self._question, single, positions, bounds)
        inside = positions[:found] < self._sketch.size
        return positions[:found][inside], bounds[:found][inside]


@compiled
def fill_boxes(
    codes: ByteArray, order: PositionArray, start: int, boxed: ByteArray, lows: ByteArray, highs: ByteArray
) -> None:
    """Put codes (m, g), in some order, into boxes (n, g, r) from a position on; widen lows and highs."""
    size = boxed.shape[2]
    for i in range(len(order)):
        box, place = (start + i) // size, (start + i) % size
        for g in range(codes.shape[1]):
            code = codes[order[i], g]
            boxed[box, g, place] = code
            lows[g, box] = min(lows[g, box], code)
            highs[g, box] = max(highs[g, box], code)
