"""Colour curves: the mean colour along an order of the surface that bending keeps."""

import numpy as np

from worker.arrays import FloatArray

FLOOR = 1.0  # Lab units; a surface of one colour is not stretched into noise


def colour_curves(orders: FloatArray, lab: FloatArray, areas: FloatArray, n_bins: int) -> FloatArray:
    """Return the mean colour in bins of equal area along each order.

    Parameters
    ----------
    orders : (n, t) array
        Quantities by which the surface is ordered: heat kernel signatures at t times.
    lab : (n, 3) array
        CIE Lab of the vertices.
    areas : (n,) array
        Areas of the vertices; one that lies across the border of two bins counts in both by its parts.
    n_bins : int

    Returns
    -------
    (t, n_bins, 3) array
        CIE Lab.
    """
    edges = np.linspace(0.0, areas.sum(), n_bins + 1)
    curves = [
        _means_between(edges, lab[order], areas[order]) for order in np.argsort(orders.T, kind="stable")
    ]
    return np.stack(curves)


def whiten_curves(curves: FloatArray) -> FloatArray:
    """Remove what lighting changes: the mean, and the spread of L and of (a, b).

    Contrast, brightness, saturation and (nearly) hue changes are affine in Lab and cancel.

    Parameters
    ----------
    curves : (t, b, 3) array

    Returns
    -------
    (3 t b,) array
        Mean 0 and deviation 1 in L; in a and b together, mean 0 each and deviation 1.
    """
    mean, spread = light_of(curves)
    return np.asarray(((curves - mean) / spread).ravel())


def light_of(curves: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the mean colour (3,) that whitening takes off curves (t, b, 3), and by what it divides (3,)."""
    mean = curves.mean(axis=(0, 1))
    centred = curves - mean
    lightness = np.sqrt(np.mean(centred[..., 0] ** 2))
    chroma = np.sqrt(np.mean(centred[..., 1:] ** 2))
    return mean, np.maximum(np.array([lightness, chroma, chroma]), FLOOR)


def _means_between(edges: FloatArray, lab: FloatArray, areas: FloatArray) -> FloatArray:
    """Average an ordered step function between the edges; (b, 3)."""
    ends = np.concatenate([[0.0], np.cumsum(areas)])  # (n + 1,)
    integrals = np.vstack([np.zeros(3), np.cumsum(areas[:, None] * lab, axis=0)])
    at_edges = np.stack([np.interp(edges, ends, column) for column in integrals.T], axis=1)
    return np.diff(at_edges, axis=0) / np.diff(edges)[:, None]
