"""Candidates: the rows that may be near one query, by what a sketch tells of them."""

import numpy as np

from index.arrays import PositionArray, RowArray, SingleArray
from index.bounds import Question, box_bounds, coarse_bounds, collect, fine_bounds
from index.coding import Coding
from index.methods import Method
from index.sketch import BOX, Sketch

MARGIN = 1e-5  # relative, by which bounds in single precision may exceed the true ones
LIKELY = 16  # boxes in which likely rows are looked for


class Candidates:
    """One query beside a sketch.

    Parameters
    ----------
    sketch : Sketch
    query : (width,) array
        As the layout keeps it.
    method : Method
        Of the sketch's layout, perhaps with other weights.
    largest : float
        As in `Coding.ends`.
    """

    def __init__(self, sketch: Sketch, query: RowArray, method: Method, largest: float) -> None:
        self._sketch = sketch
        self._query = query
        self._coarse = _question(sketch.coarse, query, method, largest)
        self._fine = _question(sketch.fine, query, method, largest)
        self._boxes = np.empty(0, np.int64)  # those that were looked at,
        self._bounds = np.empty((0, BOX), np.float32)  # of their rows,
        self._least = np.empty(0, np.float32)  # of all of a box's

    def by_centres(self, count: int) -> PositionArray:
        """Return positions that are likely to be near: the likeliest in the boxes of the nearest centres."""
        place = self._sketch.coarse.places(self._query[None])[0] * self._sketch.coarse.counts
        self._look(self._sketch.centres.nearest(place.astype(np.float32), LIKELY))
        return self._likeliest(np.arange(len(self._boxes)), count)

    def by_rows(self, limit: float, count: int) -> PositionArray:
        """Look at all rows in boxes that may hold one within a distance; return likelier positions."""
        bounds = np.empty(self._sketch.lows.shape[1], np.float32)
        box_bounds(self._sketch.lows, self._sketch.highs, self._coarse, bounds)
        self._look(np.flatnonzero(bounds[: self._sketch.n_boxes] <= _above(limit)))
        few = min(LIKELY, len(self._boxes)) - 1
        return self._likeliest(np.argpartition(self._least, few)[: few + 1], count)

    def within(self, limit: float) -> tuple[PositionArray, SingleArray]:
        """Return positions looked at whose rows may be within a distance, ascending, and their bounds."""
        positions = self._rows(np.flatnonzero(self._least <= _above(limit)), _above(limit))
        bounds = np.empty(len(positions), np.float32)
        fine_bounds(self._sketch.codes, positions, self._fine, bounds)
        near = bounds <= _above(limit)
        return positions[near], bounds[near]

    def _look(self, boxes: PositionArray) -> None:
        self._boxes = boxes
        self._bounds = np.empty((len(boxes), BOX), np.float32)
        self._least = np.empty(len(boxes), np.float32)
        coarse_bounds(self._sketch.boxes, boxes, self._coarse, self._bounds, self._least)

    def _likeliest(self, places: PositionArray, count: int) -> PositionArray:
        positions = self._rows(places, np.inf)
        if len(positions) <= count:
            return positions
        bounds = np.empty(len(positions), np.float32)
        fine_bounds(self._sketch.codes, positions, self._fine, bounds)
        return positions[np.argpartition(bounds, count)[:count]]

    def _rows(self, places: PositionArray, limit: float) -> PositionArray:
        """Return the positions, in some of the boxes looked at, of rows with a bound within a limit."""
        found = np.empty(len(places) * BOX, np.int64)
        found = found[: collect(self._bounds, places, limit, found)]
        positions = self._boxes[found // BOX] * BOX + found % BOX
        return positions[positions < self._sketch.size]


def _question(coding: Coding, query: RowArray, method: Method, largest: float) -> Question:
    blocks = coding.merges.blocks
    weights = (coding.layout.weights(method)[blocks] * coding.steps**method.power).astype(np.float32)
    return Question.of(*coding.ends(query, largest), blocks, weights, method.power)


def _above(limit: float) -> float:
    with np.errstate(over="ignore"):  # then it is infinite, and rules out nothing
        return float(np.float32(limit * (1.0 + MARGIN)))
