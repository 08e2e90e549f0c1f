"""Contributions: how much each point of two surfaces adds to the L1 distance of their descriptors.

Each function works on one of the two: it is given what this surface has that the other lacks, and places it
where this surface has it. Done on both, the whole distance is placed once. Densities c are per share of the
surface's area, whatever its triangles: with shares a_v of the area at the points, Σ_v a_v c_v over both
surfaces is the distance.
"""

import numpy as np

from worker.arrays import FloatArray
from worker.descriptors.bags import ROWS, soft_assignment
from worker.descriptors.curves import light_of, whiten_curves
from worker.descriptors.histograms import join_bins, lab_histogram, look_up_cells
from worker.parameters import Parameters


def word_densities(
    signatures: FloatArray, shares: FloatArray, words: FloatArray, softness: float, surplus: FloatArray
) -> FloatArray:
    """Place what a surface has more of in some words on the points that belong to these words.

    With b_w = Σ_v a_v θ_vw the surface's share in word w, the density is c_v = Σ_w θ_vw s_w / b_w.

    Parameters
    ----------
    signatures : (n, d) array
        In the units of the words.
    shares : (n,) array
        a, of the area; they sum to 1.
    words : (v, d) array
    softness : float
        σ, as for `worker.descriptors.bags.bag_of_features`; θ is its soft assignment.
    surplus : (v,) array
        s ≥ 0, by how much the surface has more of each word than the other.

    Returns
    -------
    (n,) array
        c ≥ 0 with Σ_v a_v c_v = Σ_w s_w; but what is surplus in a word that no point belongs to has no place.
    """
    theta = np.concatenate(
        [soft_assignment(signatures[i : i + ROWS], words, softness) for i in range(0, len(signatures), ROWS)]
    )  # (n, v)
    return np.asarray(theta @ _quotient(surplus, shares @ theta))


def cell_densities(
    lab: FloatArray, shares: FloatArray, held: FloatArray, surplus: FloatArray, parameters: Parameters
) -> FloatArray:
    """Place what a surface has more of in some cells of the colour histogram on the points of these colours.

    The histogram is of the source's own colours, while points hold averages over their cells: fine patterns
    have colours that no point has. So a cell h_c of which the points hold only m_c < h_c has only this part
    of its surplus placed; the rest has no place.

    Parameters
    ----------
    lab : (n, 3) array
        CIE Lab of the points.
    shares : (n,) array
        a, of the area; they sum to 1.
    held : (c,) array
        h, the surface's histogram.
    surplus : (c,) array
        s ≥ 0, by how much the surface has more in each cell than the other.
    parameters : Parameters
        Of the histogram.

    Returns
    -------
    (n,) array
        Not negative; Σ_v a_v c_v = Σ_c s_c min(1, m_c / h_c).
    """
    bins = (parameters.histogram_bins, parameters.histogram_smoothing)
    cells = (parameters.histogram_bins, parameters.histogram_lightness, parameters.histogram_chroma)
    own = join_bins(lab_histogram(lab, *bins, shares), *cells)  # (c,)
    inside = shares @ look_up_cells(np.ones_like(own), lab, *bins, *cells[1:])  # what smoothing leaves of 1
    found = look_up_cells(_quotient(surplus, np.maximum(held, own)), lab, *bins, *cells[1:])
    return np.asarray(found / inside)


def curve_densities(
    orders: FloatArray, lab: FloatArray, shares: FloatArray, own: FloatArray, other: FloatArray, amount: float
) -> FloatArray:
    """Place some of the difference of two surfaces' colour curves on one of them.

    A part that changes its colour moves the mean and the spread that whitening takes out, so that whitened
    curves differ everywhere. So a bin counts by the smaller of two gaps, that of the whitened curves and that
    of the colours as they are. In the bin it is laid on those points that cause it: whose colours lie to this
    surface's side, each by how far. The middle one of the orders decides: parts that share a bin of one order
    seldom share one of another.

    Parameters
    ----------
    orders : (n, t) array
        As for `worker.descriptors.curves.colour_curves`.
    lab : (n, 3) array
        CIE Lab of the points.
    shares : (n,) array
        Of the area; they sum to 1.
    own, other : (t, b, 3) arrays
        Curves of the two surfaces, not whitened.
    amount : float
        What is placed; evenly where no bin has a gap.

    Returns
    -------
    (n,) array
        Not negative; Σ_v a_v c_v = amount.
    """
    spread = light_of(own)[1]
    whitened = (whiten_curves(own) - whiten_curves(other)).reshape(own.shape)
    gaps = _smaller((own - other) / spread, whitened)
    by_order = np.empty(orders.T.shape)  # (t, n)
    for place, order in enumerate(np.argsort(orders.T, kind="stable")):
        masses = _bin_masses(lab[order] / spread, shares[order], own[place] / spread, gaps[place])
        by_order[place, order] = _quotient(masses, shares[order])
    densities = np.median(by_order, axis=0)
    total = float(shares @ densities)
    return np.asarray(densities * (amount / total)) if total > 0.0 else np.full(len(lab), amount)


def _smaller(one: FloatArray, other: FloatArray) -> FloatArray:
    """Return the smaller of two gaps; 0 where they go to opposite sides."""
    sign = np.sign(one)
    return np.asarray(sign * np.clip(sign * other, 0.0, np.abs(one)))


def _bin_masses(colours: FloatArray, shares: FloatArray, curve: FloatArray, gaps: FloatArray) -> FloatArray:
    """Place the gaps (b, 3) of a curve (b, 3) on ordered points; (n,)."""
    n_bins = len(curve)
    ends = np.cumsum(shares)
    edges = np.linspace(0.0, ends[-1], n_bins + 1)
    borders = np.unique(np.concatenate([[0.0], ends, edges[1:-1]]))  # between pieces of one point in one bin
    lengths, middles = np.diff(borders), (borders[1:] + borders[:-1]) / 2.0
    points, bins = np.searchsorted(ends, middles), np.searchsorted(edges, middles) - 1
    beyond = np.sign(gaps)[bins] * (colours[points] - (curve - gaps)[bins])  # (p, 3)
    weights = lengths[:, None] * np.maximum(beyond, 0.0)
    totals = np.stack([np.bincount(bins, column, n_bins) for column in weights.T], axis=1)  # (b, 3)
    masses = (weights * _quotient(np.abs(gaps), totals.astype(np.float64))[bins]).sum(axis=1)
    return np.asarray(np.bincount(points, masses, len(shares)))


def _quotient(numerator: FloatArray, denominator: FloatArray) -> FloatArray:
    """Divide; 0 where the denominator is 0."""
    return np.divide(numerator, denominator, out=np.zeros_like(numerator), where=denominator > 0.0)
