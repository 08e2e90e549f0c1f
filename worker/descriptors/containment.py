"""Containment: whether a surface is what is left of another, found where it was.

Iterated closest points from the part to the whole alone: each point of a part has its like on the whole, not
the other way round. What a cut leaves keeps some of its sides, so starts lay the corners of the two bounding
boxes on each other.
"""

from itertools import product

import numpy as np

from worker.arrays import FloatArray
from worker.descriptors.alignment import APART, Placed, fitted

TRIED = 3  # starts, the best of all
FEW = 96  # points by which starts are compared and the part is brought near


def gap(part: Placed, whole: Placed, scale: float) -> float:
    """Return how far a part lies from a whole where it lies furthest, laid on it as well as can be.

    Only shifts and the small turns that follow from them are tried: a part is looked for as it was cut off.

    Parameters
    ----------
    part, whole : Placed
        Each scaled to the canonical area.
    scale : float
        By which the part must be multiplied to have the whole's size.

    Returns
    -------
    float
        Units of length on the whole: all but a twentieth of the part's points lie nearer.
    """
    vertices = scale * part.vertices
    points = scale * part.points
    best = min(
        (_brought(whole, points[:FEW], shift) for shift in _starts(whole, vertices, points[:FEW])),
        key=lambda found: found[0],
    )
    _, turn, shift = best
    turn, shift = fitted(whole, points, turn, shift)
    return float(np.quantile(whole.near(points @ turn.T + shift)[0], APART))


def _brought(whole: Placed, points: FloatArray, shift: FloatArray) -> tuple[float, FloatArray, FloatArray]:
    turn, shift = fitted(whole, points, np.eye(3), shift)
    return float(whole.near(points @ turn.T + shift)[0].mean()), turn, shift


def _starts(whole: Placed, vertices: FloatArray, points: FloatArray) -> list[FloatArray]:
    """Return the shifts (3,) from which most points lie near at once, the best first."""
    low, high = whole.vertices.min(0) - vertices.min(0), whole.vertices.max(0) - vertices.max(0)
    shifts = np.array([np.where(side, low, high) for side in product((True, False), repeat=3)])
    clouds = (points + shifts[:, None]).reshape(-1, 3)  # (8 p, 3)
    distances = whole.near(clouds)[0].reshape(len(shifts), -1).mean(axis=1)
    return [shifts[place] for place in np.argsort(distances, kind="stable")[:TRIED]]
