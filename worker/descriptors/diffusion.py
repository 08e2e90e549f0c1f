"""Diffusion distances between the points of a surface, and their distribution."""

import numpy as np

from worker.arrays import FloatArray, SingleArray

FINE_BINS = 1 << 16  # of the histogram from which quantiles are read


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
    decay = np.exp(-eigenvalues * time)
    coordinates = eigenfunctions * decay  # (s, k); constant functions cancel in the differences
    coordinates = (coordinates - coordinates.mean(axis=0)).astype(np.float32)
    norms = np.square(coordinates).sum(axis=1)
    squares = np.add.outer(norms, norms)  # (s, s)
    squares -= np.float32(2.0) * (coordinates @ coordinates.T)
    np.maximum(squares, 0.0, out=squares)
    np.fill_diagonal(squares, 0.0)
    return np.asarray(np.sqrt(squares, out=squares))


def joint_distances(spectra: list[tuple[FloatArray, FloatArray]], times: tuple[float, ...]) -> SingleArray:
    """Return the mean over times of the product over operators of diffusion distances.

    Kovnatsky et al. (2011), section 5: one operator is the geometric case, one for each η the joint one.

    Parameters
    ----------
    spectra : list of (eigenvalues (k,), eigenfunctions (s, k))
        One for each η.
    times : tuple of float

    Returns
    -------
    (s, s) array
    """
    total = np.zeros(())
    for time in times:
        product = diffusion_distances(*spectra[0], time)
        for spectrum in spectra[1:]:
            product *= diffusion_distances(*spectrum, time)
        total = total + product
    return np.asarray(total / len(times), dtype=np.float32)


def distance_quantiles(distances: SingleArray, areas: FloatArray, n_levels: int) -> FloatArray:
    """Return the distances below which given shares of the pairs of area lie.

    Parameters
    ----------
    distances : (s, s) array
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
    bins = np.minimum((distances * np.float32(FINE_BINS / longest)).astype(np.int32), FINE_BINS - 1)
    shares = areas / areas.sum()
    counts = np.zeros(FINE_BINS)
    for row, share in zip(bins, shares, strict=True):
        counts += share * np.bincount(row, shares, FINE_BINS)
    cumulative = np.concatenate([[0.0], np.cumsum(counts)])
    levels = (np.arange(n_levels) + 0.5) / n_levels
    edges = np.linspace(0.0, longest, FINE_BINS + 1)
    return np.interp(levels, cumulative, edges)


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
