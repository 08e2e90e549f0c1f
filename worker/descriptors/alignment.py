"""Alignment: two surfaces laid on each other by turning and shifting alone, and what then lies apart.

Iterated closest points (Besl and McKay 1992) from several starts: the principal axes of both, one way and the
other, and steps about those that cannot be told apart. Mirror images do not fit: no turn makes a left hand
a right one.
"""

from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from worker.arrays import FloatArray, IntArray
from worker.geometry.sampling import farthest_points

POINTS = 256  # of each surface, laid on the other
FEW = 64  # of them, by which starts are compared
TRIED = 4  # starts, the best of all
TURNS = 40  # of matching and fitting, at most
SETTLED = 0.01  # units by which the mean distance must fall for another turn
KEPT = 0.9  # share of the points that decide the fit: the best
APART = 0.95  # share of the points that lie no further from the other surface than the misfit
FITS = 1.2  # units: a misfit that is as good as none, so that no other start is tried
ALIKE = 0.8  # ratio of two principal moments from which on their axes cannot be told apart
STEP = 30  # degrees between starts about such axes


@dataclass(frozen=True, eq=False)
class Placed:
    """A surface where it is."""

    vertices: FloatArray  # (n, 3), centred anywhere
    faces: IntArray  # (m, 3)

    @cached_property
    def points(self) -> FloatArray:
        """Some points (p, 3), evenly spread; the first of them are spread as well."""
        return self.vertices[farthest_points(self.vertices, POINTS)]

    @cached_property
    def everywhere(self) -> FloatArray:
        """Vertices and the middles of faces, (n + m, 3)."""
        return np.vstack([self.vertices, self.vertices[self.faces].mean(axis=1)])

    def near(self, points: FloatArray) -> tuple[FloatArray, IntArray]:
        """Return how far points (p, 3) lie from the surface, (p,), and at which of `everywhere`, (p,)."""
        distances, places = self._tree.query(points)
        return np.asarray(distances, np.float64), np.asarray(places, np.int64)

    @cached_property
    def _tree(self) -> cKDTree:
        return cKDTree(self.everywhere)

    @cached_property
    def moments(self) -> tuple[FloatArray, FloatArray]:
        """Return principal moments (3,), ascending, and their axes (3, 3), one a column."""
        centred = self.vertices - self.vertices.mean(axis=0)
        values, axes = np.linalg.eigh(centred.T @ centred / len(centred))
        return values, axes * np.sign(np.linalg.det(axes))


def misfit(one: Placed, other: Placed) -> float:
    """Return how far two surfaces lie apart where they lie furthest, laid on each other as well as can be.

    Parameters
    ----------
    one, other : Placed
        Of the same area.

    Returns
    -------
    float
        Units of length: all but a twentieth of the points of each lie nearer to the other. The same in both
        directions.
    """
    still, moved = sorted((one, other), key=lambda placed: placed.vertices.tobytes())
    best = np.inf
    for start in _starts(still, moved):
        best = min(best, _misfit_from(still, moved, start))
        if best <= FITS:
            break
    return best


def _misfit_from(still: Placed, moved: Placed, start: FloatArray) -> float:
    turn, shift = fitted(still, moved.points, start, still.vertices.mean(0) - start @ moved.vertices.mean(0))
    there, _ = still.near(moved.points @ turn.T + shift)
    back, _ = moved.near((still.points - shift) @ turn)
    return float(max(np.quantile(there, APART), np.quantile(back, APART)))


def fitted(
    still: Placed, points: FloatArray, turn: FloatArray, shift: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Turn and shift points (p, 3) until they come no nearer; return the turn (3, 3) and the shift (3,)."""
    before = np.inf
    for _ in range(TURNS):
        distances, places = still.near(points @ turn.T + shift)
        if before - distances.mean() < SETTLED:
            break
        before = float(distances.mean())
        kept = distances <= np.quantile(distances, KEPT)
        turn, shift = _rigid(points[kept], still.everywhere[places[kept]])
    return turn, shift


def _rigid(points: FloatArray, wanted: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the turn and the shift that bring points nearest to others, pair by pair (Kabsch 1976)."""
    centre, goal = points.mean(axis=0), wanted.mean(axis=0)
    left, _, right = np.linalg.svd((wanted - goal).T @ (points - centre))
    proper = np.diag([1.0, 1.0, np.sign(np.linalg.det(left @ right))])
    turn = left @ proper @ right
    return turn, goal - turn @ centre


def _starts(still: Placed, moved: Placed) -> list[FloatArray]:
    """Return the turns from which most points lie near at once, the best first."""
    values, goal = still.moments
    _, own = moved.moments
    turns = [goal @ about @ own.T for about in _abouts(values)]
    points = moved.points[:FEW] - moved.vertices.mean(axis=0)
    clouds = np.concatenate([points @ turn.T for turn in turns]) + still.vertices.mean(axis=0)
    distances = still.near(clouds)[0].reshape(len(turns), -1).mean(axis=1)
    return [turns[place] for place in np.argsort(distances, kind="stable")[:TRIED]]


def _abouts(values: FloatArray) -> list[FloatArray]:
    """Return the turns of principal axes that may be right: half turns, and steps about like axes."""
    half = [
        np.diag(signs) for signs in ((1.0, 1.0, 1.0), (1.0, -1.0, -1.0), (-1.0, 1.0, -1.0), (-1.0, -1.0, 1.0))
    ]
    low, high = (values[:2] >= ALIKE * values[1:]).tolist()
    axes = [axis for axis, alike in (("z", low), ("x", high)) if alike]  # across the axes that look alike
    steps = [range(0, 180, STEP)] * len(axes)
    turned = (
        [Rotation.from_euler("".join(axes), turn, degrees=True).as_matrix() for turn in product(*steps)]
        if axes
        else [np.eye(3)]
    )
    return [first @ second for first in turned for second in half]
