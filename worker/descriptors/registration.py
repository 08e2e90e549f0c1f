"""Registration: how well one shape's landmarks lie on another's, once their light is made the same.

Points are matched by how heat leaves them and by colour in turns, as in iterated closest points (Besl and
McKay 1992), but in the space of descriptors, where neither pose nor place counts. What a cut, a ball stuck on
or a hole adds to either side falls mostly into the worst tenth, which does not count.
"""

from dataclasses import dataclass

import numpy as np

from worker.arrays import SingleArray
from worker.descriptors.colour_change import ColourChange, fit_change
from worker.descriptors.landmarks import LONGER, SHORTER, Landmarks, rates_at

KEPT = 0.9  # share of the area whose residuals count: the best
COLOUR_UNIT = 10.0  # Lab units that weigh as much as a usual deviation of a rate
SOFTNESS = 0.5  # σ of the first, geometric matching, in deviations
TURNS = 3  # of matching and fitting
SHIFTS = tuple(range(-SHORTER, LONGER + 1))  # tried for the query's times: it may be larger or be cut


@dataclass(frozen=True, kw_only=True)
class Registration:
    """What is left between a query and a stored shape, and what was done to bring them together."""

    forwards: float  # mean distance of the query's points to the shape's, geometry and colour
    backwards: float  # the other way round
    geometry: float  # mean distance of the query's points by geometry alone, in usual deviations
    bending: float  # the same between the points that geometry and colour together matched, none left out
    change: ColourChange  # from the shape's colours to the query's

    def distance(self) -> float:
        """Return one number: all residuals in usual deviations, and a price for an unusual light.

        The weights lie in the middle of a plateau: halving or doubling one of them costs less than a point
        of mAP.
        """
        geometry = 2.0 * (self.geometry + self.bending)
        return self.forwards + self.backwards + geometry + 0.15 * self.change.unusual()


def register(ladder: SingleArray, lab: SingleArray, shares: SingleArray, shape: Landmarks) -> Registration:
    """Bring a query's landmarks onto a shape's.

    Parameters
    ----------
    ladder : (p, j) array
        log h_t of the query's landmarks at the times of `landmarks.LADDER`.
    lab : (p, 3) array
        Their colours.
    shares : (p,) array
        Their shares of the area.
    shape : Landmarks
        Of the stored shape.

    Returns
    -------
    Registration
    """
    geometry, squares = _best_shift(ladder, shares, shape)
    softest = _soft_matches(squares, shape.shares)
    change = fit_change(softest @ shape.lab, lab, shares)
    for _ in range(TURNS):
        joint = squares + _colour_squares(lab, change.apply(shape.lab))
        matches = joint.argmin(axis=1)
        residuals = np.sqrt(joint[np.arange(len(matches)), matches])
        change = fit_change(shape.lab[matches], lab, shares * np.exp(-residuals))
    joint = squares + _colour_squares(lab, change.apply(shape.lab))
    matches = joint.argmin(axis=1)
    return Registration(
        forwards=trimmed_mean(np.sqrt(joint[:, shape.shares > 0].min(axis=1)), shares),
        backwards=trimmed_mean(np.sqrt(joint[shares > 0].min(axis=0)), shape.shares),
        geometry=geometry,
        bending=float(shares @ np.sqrt(squares[np.arange(len(matches)), matches])),
        change=change,
    )


def trimmed_mean(residuals: SingleArray, shares: SingleArray) -> float:
    """Average residuals (p,) by area over the best KEPT share of it."""
    order = np.argsort(residuals, kind="stable")
    ordered = shares[order]
    ends = np.minimum(np.cumsum(ordered), KEPT * ordered.sum())
    weights = np.diff(ends, prepend=0.0)
    return float(weights @ residuals[order] / weights.sum())


def _best_shift(ladder: SingleArray, shares: SingleArray, shape: Landmarks) -> tuple[float, SingleArray]:
    """Find the shift of times at which the query fits best; its residual and squared distances (p, p')."""
    tried = []
    for shift in SHIFTS:
        squares = _squares(rates_at(ladder, shift), shape.rates)
        squares[:, shape.shares == 0] = np.inf
        tried.append((trimmed_mean(np.sqrt(squares.min(axis=1)), shares), squares))
    return min(tried, key=lambda found: found[0])


def _soft_matches(squares: SingleArray, shares: SingleArray) -> SingleArray:
    """Return for each point of the query weights (p, p') over the shape's; rows sum to 1."""
    nearest = squares.min(axis=1, keepdims=True)
    weights = np.exp((nearest - squares) / np.float32(2.0 * SOFTNESS**2)) * shares
    return np.asarray(weights / weights.sum(axis=1, keepdims=True))


def _colour_squares(first: SingleArray, second: SingleArray) -> SingleArray:
    return _squares(first / np.float32(COLOUR_UNIT), second / np.float32(COLOUR_UNIT))


def _squares(first: SingleArray, second: SingleArray) -> SingleArray:
    """Return squared distances of all pairs of rows; (m, n)."""
    squares = first @ (np.float32(-2.0) * second).T
    squares += np.square(first).sum(axis=1)[:, None]
    squares += np.square(second).sum(axis=1)
    return np.maximum(squares, np.float32(0.0), out=squares)
