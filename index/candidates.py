"""Candidates: the rows that may be near one query, by what a sketch tells of them."""

import numpy as np

from index.arrays import DoubleArray, PositionArray, RowArray, SingleArray
from index.bounds import Question, box_bounds, fine_bounds, least_bounds, rows_within
from index.coding import Coding
from index.methods import Method
from index.sketch import BOX, Sketch

MARGIN = 1e-4  # relative, by which bounds in single precision may exceed the true ones
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
        of_steps = [_weights(coding, method) for coding in (sketch.coarse, sketch.fine)]
        self._unit = max(float(weights.max()) for weights in of_steps) or 1.0  # of all bounds
        self._coarse, self._fine = (
            _question(coding, query, weights / self._unit, method.power, largest)
            for coding, weights in zip((sketch.coarse, sketch.fine), of_steps, strict=True)
        )
        self._boxes = np.empty(0, np.int64)  # those whose rows were looked at,
        self._bounds = np.empty(0, np.float32)  # and a bound for all rows in each

    def by_centres(self, count: int) -> PositionArray:
        """Return positions that are likely to be near: the likeliest in the boxes of the nearest centres."""
        place = self._sketch.coarse.places(self._query[None])[0] * self._sketch.coarse.counts
        return self._likeliest(self._sketch.centres.nearest(place.astype(np.float32), LIKELY), count)

    def by_rows(self, limit: float, count: int) -> PositionArray:
        """Look at all rows in boxes that may hold one within a distance; return likelier positions."""
        bounds = np.empty(self._sketch.lows.shape[1], np.float32)
        box_bounds(self._sketch.lows, self._sketch.highs, self._coarse, bounds)
        self._boxes = np.flatnonzero(bounds[: self._sketch.n_boxes] <= self._above(limit))
        self._bounds = np.empty(len(self._boxes), np.float32)
        least_bounds(self._sketch.boxes, self._boxes, self._coarse, self._bounds)
        few = min(LIKELY, len(self._boxes)) - 1
        return self._likeliest(self._boxes[np.argpartition(self._bounds, few)[: few + 1]], count)

    def within(self, limit: float) -> tuple[PositionArray, DoubleArray]:
        """Return positions looked at whose rows may be within a distance, ascending, and their bounds."""
        above = self._above(limit)
        positions = self._rows(self._boxes[self._bounds <= above], above)
        bounds = self._finely(positions)
        near = bounds <= above
        return positions[near], bounds[near] * np.float64(self._unit)

    def _above(self, limit: float) -> float:
        with np.errstate(over="ignore"):  # then it is infinite, and rules out nothing
            return float(np.float32(limit / self._unit * (1.0 + MARGIN)))

    def _likeliest(self, boxes: PositionArray, count: int) -> PositionArray:
        positions = self._rows(boxes, np.inf)
        if len(positions) <= count:
            return positions
        return positions[np.argpartition(self._finely(positions), count)[:count]]

    def _rows(self, boxes: PositionArray, limit: float) -> PositionArray:
        """Return the positions of the rows in some boxes with a coarse bound within a limit."""
        positions = np.empty(len(boxes) * BOX, np.int64)
        positions = positions[: rows_within(self._sketch.boxes, boxes, self._coarse, limit, positions)]
        return positions[positions < self._sketch.size]

    def _finely(self, positions: PositionArray) -> SingleArray:
        bounds = np.empty(len(positions), np.float32)
        fine_bounds(self._sketch.codes, positions, self._fine, bounds)
        return bounds


def _weights(coding: Coding, method: Method) -> DoubleArray:
    """Return what a sum of steps of each group weighs, (g,)."""
    return np.asarray(coding.layout.weights(method)[coding.merges.blocks] * coding.steps**method.power)


def _question(coding: Coding, query: RowArray, weights: DoubleArray, power: int, largest: float) -> Question:
    """Ask in single precision: weights are 1 at most, and so small ones that it would round much are 0."""
    kept = np.where(weights < np.finfo(np.float32).tiny, 0.0, weights).astype(np.float32)
    return Question.of(*coding.ends(query, largest), coding.merges.blocks, kept, power)
