"""Bags of features: how a surface's area is shared among the words of a vocabulary."""

import numpy as np

from worker.arrays import FloatArray

ROWS = 512  # points taken at once: their shares stay in a processor's cache


def bag_of_features(
    signatures: FloatArray, areas: FloatArray, words: FloatArray, softness: float
) -> FloatArray:
    """Share out the area of a surface among words.

    Bronstein, Bronstein, Guibas and Ovsjanikov (2011), "Shape Google", section 3: each point gives itself to
    word l in proportion to exp(−‖p − w_l‖² / 2σ²); the shares are integrated over the surface.

    Parameters
    ----------
    signatures : (n, d) array
        p, one row a point.
    areas : (n,) array
        Area of each point's cell.
    words : (v, d) array
        w.
    softness : float
        σ, in the units of the signatures; 0 gives each point wholly to its nearest word.

    Returns
    -------
    (v,) array
        Not negative, sums to 1; zeros where there is no point.
    """
    if not len(signatures):
        return np.zeros(len(words))
    total = np.zeros(len(words))
    for start in range(0, len(signatures), ROWS):
        rows = slice(start, start + ROWS)
        total += areas[rows] @ soft_assignment(signatures[rows], words, softness)
    return np.asarray(total / areas.sum())


def soft_assignment(signatures: FloatArray, words: FloatArray, softness: float) -> FloatArray:
    """Return each point's shares in the words, (n, v); rows sum to 1. Arguments as for `bag_of_features`."""
    centre = words.mean(axis=0)  # differences of large numbers lose digits
    points, words = signatures - centre, words - centre
    squares = np.sum(words**2, axis=1) - 2.0 * points @ words.T  # less what a point's own distances share
    squares -= squares.min(axis=1, keepdims=True)
    if softness == 0:
        return np.asarray(np.eye(len(words))[np.argmin(squares, axis=1)])
    shares = np.exp((squares * (-0.5 / softness**2)).astype(np.float32))  # single: to 1e-6 of a share
    return np.asarray(shares / shares.sum(axis=1, keepdims=True), np.float64)
