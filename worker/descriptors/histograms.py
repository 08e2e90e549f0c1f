"""Histograms of a surface's colours in CIE Lab: fine bins that are smoothed, then joined into fewer."""

from collections.abc import Iterator
from functools import cache

import numpy as np
from scipy.ndimage import binary_dilation, gaussian_filter

from worker.arrays import BoolArray, FloatArray, IntArray
from worker.geometry.colour import srgb_to_lab

LOWER = np.array([0.0, -80.0, -80.0])  # of L, a, b; colours outside count in the outermost bins
UPPER = np.array([100.0, 80.0, 80.0])
REACH = 2  # bins to which smoothing spreads a colour
CUBE = 33  # sRGB values along each side by which the gamut is found


def lab_histogram(
    lab: FloatArray, n_bins: int, smoothing: float, areas: FloatArray | None = None
) -> FloatArray:
    """Return the smoothed histogram of colour samples.

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
    areas : (k,) array, optional
        That the samples stand for; all the same where none are given.

    Returns
    -------
    (b,) array
        Sums to 1; the bins inside the gamut, L slowest and b fastest.
    """
    inside = _smoothed(_counts(lab, n_bins, areas), smoothing)[_gamut(n_bins)]
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


def look_up_cells(
    values: FloatArray,
    lab: FloatArray,
    n_bins: int,
    smoothing: float,
    lightness: tuple[int, ...],
    chroma: tuple[int, ...],
) -> FloatArray:
    """Return for each colour the mean of the cells' values, each by the colour's share in it.

    The transpose of what `lab_histogram` and `join_bins` do to one sample before they are divided by the sum:
    no colour's 469 shares are ever written down.

    Parameters
    ----------
    values : (c,) array
        One a cell.
    lab : (k, 3) array
        CIE Lab.
    n_bins, smoothing, lightness, chroma
        As there.

    Returns
    -------
    (k,) array
    """
    field = np.zeros((n_bins,) * 3)
    field[_gamut(n_bins)] = values[_cells(n_bins, lightness, chroma)]
    smooth = _smoothed(field, smoothing).ravel()  # a mirrored border makes it its own transpose
    found = np.zeros(len(lab))
    for places, shares in _corners(lab, n_bins):
        found += shares * smooth[places]
    return found


def _smoothed(counts: FloatArray, smoothing: float) -> FloatArray:
    return np.asarray(gaussian_filter(counts, smoothing, mode="reflect", radius=REACH))


def _counts(lab: FloatArray, n_bins: int, areas: FloatArray | None = None) -> FloatArray:
    """Share samples linearly among bins; (n_bins, n_bins, n_bins)."""
    counts = np.zeros(n_bins**3)
    for places, shares in _corners(lab, n_bins):
        counts += np.bincount(places, shares if areas is None else shares * areas, n_bins**3)
    return counts.reshape((n_bins,) * 3)


def _corners(lab: FloatArray, n_bins: int) -> Iterator[tuple[IntArray, FloatArray]]:
    """Yield eight times the bin of each colour beside it, and its share in that; both (k,)."""
    places = (lab - LOWER) / (UPPER - LOWER) * n_bins - 0.5  # (k, 3), whole at the middle of a bin
    places = np.clip(places, 0.0, n_bins - 1.0)
    lowest = np.minimum(places.astype(np.int64), n_bins - 2)
    shares = np.stack([1.0 - (places - lowest), places - lowest])  # (2, k, 3): of the lower bin, of the upper
    first = lowest @ [n_bins**2, n_bins, 1]
    for i, j, k in np.ndindex(2, 2, 2):
        yield first + (i * n_bins**2 + j * n_bins + k), shares[i, :, 0] * shares[j, :, 1] * shares[k, :, 2]


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
