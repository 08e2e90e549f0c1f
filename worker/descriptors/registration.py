"""Registration: how well one shape's landmarks lie on another's, once their light is made the same.

Points are matched by how heat leaves them and by colour in turns, as in iterated closest points (Besl and
McKay 1992), but in the space of descriptors, where neither pose nor place counts. What a cut, a ball stuck on
or a hole adds to either side falls mostly into the worst tenth, which does not count.
"""

from dataclasses import dataclass

import numpy as np

from worker.arrays import IntArray, SingleArray
from worker.descriptors.colour_change import ColourChange, fit_change
from worker.descriptors.landmarks import LONGER, SHORTER, Landmarks, present, rates_at, unpack

KEPT = 0.9  # share of the area whose residuals count: the best
COLOUR_UNIT = 10.0  # Lab units that weigh as much as a usual deviation of a rate
SOFTNESS = 0.5  # σ of the first, geometric matching, in deviations
FAINTEST = -60.0  # log of the least weight in it: numbers below the normal ones are slow to multiply
TURNS = 3  # of matching and fitting
SHIFTS = tuple(range(-SHORTER, LONGER + 1))  # tried for the query's times: it may be larger or be cut


@dataclass(frozen=True, kw_only=True, eq=False)
class Query:
    """The landmarks that shapes are registered with, made ready once for all of them."""

    rates: SingleArray  # (s, 8, p), at each of SHIFTS, lifted
    colours: SingleArray  # (5, p), in COLOUR_UNIT, lifted
    lab: SingleArray  # (3, p)
    shares: SingleArray  # (p,), of the area


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

        The weights lie on a plateau: over all queries of docs/evaluation.md, others about as large cost less
        than half a point of mAP.
        """
        geometry = 2.0 * (self.geometry + self.bending)
        return self.forwards + self.backwards + geometry + 0.15 * self.change.unusual()


def query_of(ladder: SingleArray, packed: SingleArray) -> Query:
    """Make a query's landmarks ready.

    Parameters
    ----------
    ladder : (p, j) array
        log h_t at the times of `landmarks.LADDER`.
    packed : array
        What `landmarks.pack` gave of the same points.

    Returns
    -------
    Query
    """
    own, kept = unpack(packed), ladder[present(packed)]
    rates = np.stack([rates_at(kept, shift).T for shift in SHIFTS])  # (s, 6, p)
    return Query(rates=_lifted(rates), colours=_lifted(own.lab / COLOUR_UNIT), lab=own.lab, shares=own.shares)


def register(query: Query, shape: Landmarks) -> Registration:
    """Bring a query's landmarks onto a shape's.

    Parameters
    ----------
    query : Query
    shape : Landmarks
        Of the stored shape.

    Returns
    -------
    Registration
    """
    geometry, squares = _best_shift(query, shape)
    change = fit_change(_soft_colours(squares, shape), query.lab, query.shares)
    for _ in range(TURNS):
        joint = squares + _colour_squares(query, shape, change)
        matches = joint.argmin(axis=1)
        trusted = query.shares * np.exp(-_roots(joint, matches))
        change = fit_change(shape.lab[:, matches], query.lab, trusted)
    joint = squares + _colour_squares(query, shape, change)
    matches = joint.argmin(axis=1)
    return Registration(
        forwards=float(trimmed_mean(_roots(joint, matches), query.shares)),
        backwards=float(trimmed_mean(np.sqrt(joint.min(axis=0).clip(0.0)), shape.shares)),
        geometry=geometry,
        bending=float(query.shares @ _roots(squares, matches)),
        change=change,
    )


def trimmed_mean(residuals: SingleArray, shares: SingleArray) -> SingleArray:
    """Average residuals (..., p) by area (p,) over the best KEPT share of it."""
    kept = KEPT * shares.sum()
    ends = np.minimum(shares[residuals.argsort(axis=-1)].cumsum(axis=-1), kept)  # (..., p)
    ends[..., 1:] -= ends[..., :-1].copy()
    return np.asarray(np.vecdot(ends, np.sort(residuals, axis=-1)) / kept)


def _best_shift(query: Query, shape: Landmarks) -> tuple[float, SingleArray]:
    """Find the shift of times at which the query fits best; its residual and squared distances (p, p')."""
    squares = _squares(query.rates, shape.rates)  # (s, p, p')
    residuals = np.sqrt(_nearest(squares)[..., 0].clip(0.0))
    means = trimmed_mean(residuals, query.shares)  # (s,)
    best = means.argmin()
    return float(means[best]), squares[best]


def _soft_colours(squares: SingleArray, shape: Landmarks) -> SingleArray:
    """Return the mean colour of the shape's points about each of the query's; (3, p)."""
    weights = _nearest(squares) - squares
    weights *= 0.5 / SOFTNESS**2
    np.exp(np.maximum(weights, FAINTEST, out=weights), out=weights)
    sums = np.vstack([shape.lab * shape.shares, shape.shares]) @ weights.T  # (4, p)
    return np.asarray(sums[:3] / sums[3])


def _colour_squares(query: Query, shape: Landmarks, change: ColourChange) -> SingleArray:
    return _squares(query.colours, change.apply(shape.lab) / COLOUR_UNIT)


def _lifted(points: SingleArray) -> SingleArray:
    """Add to columns (..., d, p) what makes `_squares` one product of matrices: |x|² and 1."""
    norms = (points * points).sum(axis=-2, keepdims=True)
    return np.concatenate([points, norms, np.ones_like(norms)], axis=-2)


def _squares(lifted: SingleArray, points: SingleArray) -> SingleArray:
    """Return |x|² + |y|² − 2x·y for all lifted x and all columns y of points (d, n); (..., p, n).

    Rounding may leave what should be 0 a little below it.
    """
    others = np.vstack([-2.0 * points, np.ones_like(points[0]), (points * points).sum(axis=0)])
    return np.asarray(lifted.swapaxes(-1, -2) @ others)


def _nearest(squares: SingleArray) -> SingleArray:
    """Return the least of each row (..., p, 1); numpy finds its place four times as fast as itself."""
    return np.take_along_axis(squares, squares.argmin(axis=-1, keepdims=True), axis=-1)


def _roots(squares: SingleArray, columns: IntArray) -> SingleArray:
    """Return the root of one entry of each row."""
    return np.asarray(np.sqrt(squares[np.arange(len(columns)), columns].clip(0.0)))
