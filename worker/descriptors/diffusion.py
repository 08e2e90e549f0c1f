"""Diffusion distances between the points of a surface, and their distribution.

Distances are symmetric: they are computed by blocks of rows, from the diagonal to the right, small enough to
stay in a processor's cache.
"""

from collections.abc import Iterator, Sequence

import numpy as np

from worker.arrays import FloatArray, SingleArray

FINE_BINS = 1 << 16  # of the histogram from which quantiles are read
ROWS = 128  # of a block
FADED = 1e-9  # decay from which an eigenfunction is lost in the rounding of single numbers

Spectrum = tuple[FloatArray, FloatArray]  # eigenvalues (k,), eigenfunctions at the sampled points (s, k)


def diffusion_distances(eigenvalues: FloatArray, eigenfunctions: FloatArray, time: float) -> SingleArray:
    """Return d_t(x, x') = (Σ_{i>0} e^{−2 λ_i t} (φ_i(x) − φ_i(x'))²)^½ for all pairs.

    Coifman and Lafon (2006); Kovnatsky et al. (2011), equation 7, whose second line drops the 2.

    Parameters
    ----------
    eigenvalues : (k,) array
    eigenfunctions : (s, k) array
        At the sampled points.
    time : float
        t, squared units.

    Returns
    -------
    (s, s) array
        Symmetric, 0 on the diagonal, in 1 / units; relative precision of single numbers.
    """
    return joint_distances([(eigenvalues, eigenfunctions)], (time,))


def joint_distances(spectra: Sequence[Spectrum], times: tuple[float, ...]) -> SingleArray:
    """Return the mean over times of the product over operators of diffusion distances.

    Kovnatsky et al. (2011), section 5: one operator is the geometric case, one for each η the joint one.

    Parameters
    ----------
    spectra : sequence of (eigenvalues (k,), eigenfunctions (s, k))
        One for each η.
    times : tuple of float

    Returns
    -------
    (s, s) array
    """
    n_points = len(spectra[0][1])
    distances = np.empty((n_points, n_points), dtype=np.float32)
    for start, block in zip(_starts(n_points), _blocks(spectra, times), strict=True):
        rows, right = slice(start, start + ROWS), slice(start + ROWS, None)
        corner = np.triu(
            block[:, : len(block)], 1
        )  # rounding need not be symmetric, nor leave 0 on the diagonal
        distances[rows, rows] = corner + corner.T
        distances[rows, right] = block[:, len(block) :]
        distances[right, rows] = block[:, len(block) :].T
    return distances


def distance_quantiles(distances: SingleArray, areas: FloatArray, n_levels: int) -> FloatArray:
    """Return the distances below which given shares of the pairs of area lie.

    Parameters
    ----------
    distances : (s, s) array
        Symmetric, 0 on the diagonal.
    areas : (s,) array
        Area that each sample stands for; a pair weighs the product of two.
    n_levels : int
        Levels (i + ½) / n_levels.

    Returns
    -------
    (n_levels,) array
        Ascending: the inverse of the cumulative distribution F.
    """
    longest = float(distances.max())
    if longest == 0.0:
        return np.zeros(n_levels)
    counts = _pair_histogram(distances, areas / areas.sum(), longest)
    cumulative = np.concatenate([[0.0], np.cumsum(counts)])
    levels = (np.arange(n_levels) + 0.5) / n_levels
    return np.interp(levels, cumulative, np.linspace(0.0, longest, FINE_BINS + 1))


def distribution_on_grid(quantiles: FloatArray, grid: FloatArray) -> FloatArray:
    """Read the cumulative distribution F at given distances.

    Divided by the number of grid points, so that the L1 distance of two shapes is the mean of |F − G|.

    Parameters
    ----------
    quantiles : (q,) array
        As from `distance_quantiles`.
    grid : (g,) array
        Ascending distances, the same for all shapes that are compared.

    Returns
    -------
    (g,) array
    """
    levels = (np.arange(len(quantiles)) + 0.5) / len(quantiles)
    return np.asarray(np.interp(grid, quantiles, levels, left=0.0, right=1.0) / len(grid))


def _starts(n_points: int) -> range:
    """Return the first row of each block; its columns start there as well."""
    return range(0, n_points, ROWS)


def _blocks(spectra: Sequence[Spectrum], times: tuple[float, ...]) -> Iterator[SingleArray]:
    """Yield joint distances, (≤ ROWS, s − start) for each start, noise on the diagonal."""
    systems = [[_coordinates(*spectrum, time) for spectrum in spectra] for time in times]
    for start in _starts(len(spectra[0][1])):
        products = [_product(coordinates, start) for coordinates in systems]
        for product in products[1:]:
            products[0] += product
        yield products[0] / np.float32(len(times))


def _product(systems: list[tuple[SingleArray, SingleArray]], start: int) -> SingleArray:
    """Return the product of the distances in some systems of coordinates, one block of it."""
    squares = _squares(*systems[0], start)
    for coordinates in systems[1:]:
        squares *= _squares(*coordinates, start)
    return np.asarray(np.sqrt(squares, out=squares))


def _coordinates(
    eigenvalues: FloatArray, eigenfunctions: FloatArray, time: float
) -> tuple[SingleArray, SingleArray]:
    """Return points (s, k) whose distances are d_t, and their squared norms (s,)."""
    decay = np.exp(-eigenvalues * time)
    kept = decay > FADED
    coordinates = eigenfunctions[:, kept] * decay[kept]  # constant functions cancel in the differences
    coordinates = (coordinates - coordinates.mean(axis=0)).astype(np.float32)
    return coordinates, np.square(coordinates).sum(axis=1)


def _squares(coordinates: SingleArray, norms: SingleArray, start: int) -> SingleArray:
    """Return the squared distances of one block."""
    rows = slice(start, start + ROWS)
    squares = (np.float32(-2.0) * coordinates[rows]) @ coordinates[start:].T
    squares += norms[start:]
    squares += norms[rows, None]
    return np.asarray(np.maximum(squares, 0.0, out=squares))


def _pair_histogram(distances: SingleArray, shares: FloatArray, longest: float) -> FloatArray:
    """Weigh the pairs in fine bins up to the longest distance: each point with itself, the others twice."""
    counts = np.zeros(FINE_BINS)
    counts[0] = shares @ shares
    for start in _starts(len(shares)):
        block = distances[start : start + ROWS, start:]
        bins = np.minimum((block * np.float32(FINE_BINS / longest)).astype(np.int64), FINE_BINS - 1)
        weights = np.outer(2.0 * shares[start : start + ROWS], shares[start:])
        weights[:, : len(block)] = np.triu(weights[:, : len(block)], 1)
        counts += np.bincount(bins.ravel(), weights.ravel(), FINE_BINS)
    return counts
