"""Histograms of a surface's colours in CIE Lab: fine bins that are smoothed, then joined into fewer."""

from functools import cache

import numpy as np
from scipy.ndimage import binary_dilation, gaussian_filter

from worker.arrays import BoolArray, FloatArray, IntArray
from worker.geometry.colour import srgb_to_lab

LOWER = np.array([0.0, -80.0, -80.0])  # of L, a, b; colours outside count in the outermost bins
UPPER = np.array([100.0, 80.0, 80.0])
REACH = 2  # bins to which smoothing spreads a colour
CUBE = 33  # sRGB values along each side by which the gamut is found


def lab_histogram(lab: FloatArray, n_bins: int, smoothing: float) -> FloatArray:
    """Return the smoothed histogram of equal-area colour samples.

    A sample is shared linearly among the eight bins around it, so that no colour sits on an edge (greys have
    a = b = 0); then the counts are smoothed. Only bins that sRGB can reach are kept.

    Parameters
    ----------
    lab : (k, 3) array
        CIE Lab of the samples.
    n_bins : int
        Along each axis.
    smoothing : float
        σ of the Gaussian, in bins.

    Returns
    -------
    (b,) array
        Sums to 1; the bins inside the gamut, L slowest and b fastest.
    """
    smooth = gaussian_filter(_counts(lab, n_bins), smoothing, mode="reflect", radius=REACH)
    inside = smooth[_gamut(n_bins)]
    return np.asarray(inside / inside.sum())


def join_bins(
    histogram: FloatArray, n_bins: int, lightness: tuple[int, ...], chroma: tuple[int, ...]
) -> FloatArray:
    """Sum the bins of a histogram into larger cells.

    Most surfaces are nearly grey, where a small difference of a or b already tells two apart, and few colours
    are strong: narrow cells around a = b = 0 and wide ones beyond do with a sixth of the numbers. Bins are
    smoothed before, while they are narrow.

    Parameters
    ----------
    histogram : (b,) array
        As from `lab_histogram`.
    n_bins : int
        Of that histogram, along each axis.
    lightness, chroma : tuple of int
        How many bins each cell takes along L, and along a and b, from the lower end; n_bins in all.

    Returns
    -------
    (c,) array
        Sums to the same; the cells that hold a bin of the gamut, L slowest and b fastest.
    """
    return np.asarray(np.bincount(_cells(n_bins, lightness, chroma), histogram))


def _counts(lab: FloatArray, n_bins: int) -> FloatArray:
    """Share samples linearly among bins; (n_bins, n_bins, n_bins)."""
    places = (lab - LOWER) / (UPPER - LOWER) * n_bins - 0.5  # (k, 3), whole at the middle of a bin
    places = np.clip(places, 0.0, n_bins - 1.0)
    lowest = np.minimum(places.astype(np.int64), n_bins - 2)
    shares = np.stack([1.0 - (places - lowest), places - lowest])  # (2, k, 3): of the lower bin, of the upper
    first = lowest @ [n_bins**2, n_bins, 1]
    counts = np.zeros(n_bins**3)
    for i, j, k in np.ndindex(2, 2, 2):
        weights = shares[i, :, 0] * shares[j, :, 1] * shares[k, :, 2]
        counts += np.bincount(first + (i * n_bins**2 + j * n_bins + k), weights, n_bins**3)
    return counts.reshape((n_bins,) * 3)


@cache
def _gamut(n_bins: int) -> BoolArray:
    """Tell which bins hold a colour of sRGB or lie where smoothing brings one."""
    steps = np.linspace(0.0, 1.0, CUBE)
    cube = np.stack(np.meshgrid(steps, steps, steps, indexing="ij"), axis=-1).reshape(-1, 3)
    filled = _counts(srgb_to_lab(cube), n_bins) > 0
    return np.asarray(binary_dilation(filled, iterations=1))


@cache
def _cells(n_bins: int, lightness: tuple[int, ...], chroma: tuple[int, ...]) -> IntArray:
    """Return the place of each bin's cell among the cells that are kept; (b,)."""
    axes = [np.repeat(np.arange(len(sizes)), sizes) for sizes in (lightness, chroma, chroma)]
    places = [axis[bins] for axis, bins in zip(axes, np.nonzero(_gamut(n_bins)), strict=True)]
    return np.unique(np.stack(places), axis=1, return_inverse=True)[1].ravel()
