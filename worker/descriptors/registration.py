"""Registration: how well one shape's landmarks lie on another's, once their light is made the same.

Points are matched by how heat leaves them and by colour in turns, as in iterated closest points (Besl and
McKay 1992), but in the space of descriptors, where neither pose nor place counts. What a cut, a ball stuck on
or a hole adds to either side falls mostly into the worst tenth, which does not count.
"""

from dataclasses import dataclass

import numpy as np

from worker.arrays import FloatArray, SingleArray
from worker.compiled import compiled
from worker.descriptors.colour_change import ColourChange, fit_light, relit
from worker.descriptors.landmarks import LONGER, SHORTER, WIDTH, Landmarks, present, rates_at, unpack
from worker.descriptors.matching import Places, match_backwards, match_jointly, match_rates, soft_colours
from worker.descriptors.trimming import trimmed_mean
from worker.geometry.gamut import clip_to_gamut

KEPT = 0.9  # share of the area whose residuals count: the best
COLOUR_UNIT = np.float32(10.0)  # Lab units that weigh as much as a usual deviation of a rate
SOFTNESS = 0.5  # σ of the first, geometric matching, in deviations
TURNS = 3  # of matching and fitting
SHIFTS = tuple(range(-SHORTER, LONGER + 1))  # tried for the query's times: it may be larger or be cut


@dataclass(frozen=True, kw_only=True, eq=False)
class Query:
    """The landmarks that shapes are registered with, made ready once for all of them."""

    rates: SingleArray  # (s, 6, p), at each of SHIFTS
    lab: SingleArray  # (3, p)
    colours: SingleArray  # (3, p), the same in COLOUR_UNIT
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
    return Query(rates=rates, lab=own.lab, colours=own.lab / COLOUR_UNIT, shares=own.shares)


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
    columns = np.vstack([shape.rates, shape.lab, shape.shares])  # (WIDTH, n)
    return register_all(query, columns.T[None])[0]


def register_all(query: Query, packed: SingleArray) -> list[Registration]:
    """Bring a query's landmarks onto those of several shapes, one after another.

    Parameters
    ----------
    query : Query
    packed : (m, …) array
        What `landmarks.pack` gave of each shape.
    """
    blocks = np.ascontiguousarray(packed.reshape(len(packed), -1, WIDTH))
    found = _all_registered(query.rates, query.lab, query.colours, query.shares, blocks)
    return [
        Registration(
            forwards=numbers[0],
            backwards=numbers[1],
            geometry=numbers[2],
            bending=numbers[3],
            change=ColourChange.of(numbers[4:]),
        )
        for numbers in found.tolist()
    ]


@compiled
def _all_registered(
    tried: SingleArray,
    query_lab: SingleArray,
    query_colours: SingleArray,
    query_shares: SingleArray,
    blocks: SingleArray,
) -> FloatArray:
    """Register blocks (m, n, WIDTH); return a row of `_registered` for each, (m, 9)."""
    found = np.empty((len(blocks), 9))
    for k in range(len(blocks)):
        columns = _columns(blocks[k])
        rates, lab, shares = columns[:6], columns[6:9], columns[9]
        found[k] = _registered(tried, query_lab, query_colours, query_shares, rates, lab, shares)
    return found


@compiled
def _columns(block: SingleArray) -> SingleArray:
    """Return the rows (n, WIDTH) that stand for some area as columns."""
    n_present = 0
    for row in range(len(block)):
        n_present += block[row, -1] > 0
    columns, place = np.empty((block.shape[1], n_present), np.float32), 0
    for row in range(len(block)):
        if block[row, -1] > 0:
            for k in range(block.shape[1]):
                columns[k, place] = block[row, k]
            place += 1
    return columns


@compiled
def _registered(
    tried: SingleArray,
    query_lab: SingleArray,
    query_colours: SingleArray,
    query_shares: SingleArray,
    rates: SingleArray,
    lab: SingleArray,
    shares: SingleArray,
) -> FloatArray:
    """Do what `register` says; return four residuals and five numbers of the change of light, (9,)."""
    found = np.empty(9)
    squares, nearest, found[2] = _best_shift(tried, query_shares, rates)
    change = fit_light(soft_colours(squares, nearest, SOFTNESS, lab, shares), query_lab, query_shares)
    matches = np.zeros(len(query_shares), np.int32)
    for _ in range(TURNS):
        match_jointly(squares, query_colours, _seen(lab, change), nearest, matches)
        change = fit_light(_chosen(lab, matches), query_lab, _trusted(query_shares, nearest))
    seen = _seen(lab, change)
    match_jointly(squares, query_colours, seen, nearest, matches)
    found[0] = trimmed_mean(_roots(nearest), query_shares, KEPT)
    found[1] = trimmed_mean(_roots(match_backwards(squares, query_colours, seen)), shares, KEPT)
    found[3] = _bending(squares, matches, query_shares)
    for k in range(5):
        found[4 + k] = change[k]
    return found


@compiled
def _best_shift(
    tried: SingleArray, query_shares: SingleArray, rates: SingleArray
) -> tuple[SingleArray, SingleArray, float]:
    """Find the shift of times at which the query fits best.

    Returns
    -------
    squares : (n, p) array
        Squared distances of the shape's points to the query's.
    nearest : (p,) array
        The least of each column.
    residual : float
    """
    best = np.empty((rates.shape[1], tried.shape[2]), np.float32)
    other, near, nearest = np.empty_like(best), np.empty_like(query_shares), np.empty_like(query_shares)
    least = np.inf
    for shift in range(len(tried)):
        match_rates(tried[shift], rates, other, near)
        residual = trimmed_mean(_roots(near), query_shares, KEPT)
        if residual < least or shift == 0:
            best, other, near, nearest, least = other, best, nearest, near, residual
    return best, nearest, least


@compiled
def _seen(lab: SingleArray, change: FloatArray) -> SingleArray:
    """Return colours (3, n) as a file would hold them under another light, in units of a rate."""
    seen, _ = clip_to_gamut(relit(lab, change))
    for k in range(3):
        for j in range(seen.shape[1]):
            seen[k, j] /= COLOUR_UNIT
    return seen


@compiled
def _trusted(query_shares: SingleArray, nearest: SingleArray) -> SingleArray:
    """Return how much each match says about the light: the less, the further it is."""
    trusted = np.empty_like(query_shares)
    for i in range(len(trusted)):
        trusted[i] = query_shares[i] * np.exp(-np.sqrt(nearest[i]))
    return trusted


@compiled
def _roots(squares: SingleArray) -> SingleArray:
    roots = np.empty_like(squares)
    for i in range(len(roots)):
        roots[i] = np.sqrt(squares[i])
    return roots


@compiled
def _chosen(lab: SingleArray, matches: Places) -> SingleArray:
    """Return some columns."""
    chosen = np.empty((3, len(matches)), np.float32)
    for i in range(len(matches)):
        for k in range(3):
            chosen[k, i] = lab[k, matches[i]]
    return chosen


@compiled
def _bending(squares: SingleArray, matches: Places, query_shares: SingleArray) -> float:
    total = 0.0
    for i in range(len(matches)):
        total += query_shares[i] * np.sqrt(squares[matches[i], i])
    return total
