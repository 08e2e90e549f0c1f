"""How diffusion distances between the points of a surface are distributed.

Distances are symmetric: they are computed by blocks of rows, from the diagonal to the right, and counted as
they come; the whole is never held.
"""

from collections.abc import Iterator, Sequence

import numpy as np

from worker.arrays import FloatArray, IntArray, SingleArray
from worker.compiled import compiled

SHARPNESS = 14  # binary digits of a distance, after the first, that its bin of the histogram tells
OCTAVES = 36  # of distances that the bins cover; shorter ones count as 0
FINE_BINS = OCTAVES << SHARPNESS
ROWS = 64  # of a block
FADED = 1e-4  # decay, relative to the slowest, from which a function is lost in single numbers

Spectrum = tuple[FloatArray, FloatArray]  # eigenvalues (k,), eigenfunctions at the sampled points (s, k)
Coordinates = tuple[SingleArray, SingleArray, SingleArray]  # (s, k), −2 times those (k, s), norms (s,)


def distance_quantiles(
    spectra: Sequence[Spectrum], times: tuple[float, ...], areas: FloatArray, n_levels: int
) -> FloatArray:
    """Return the diffusion distances below which given shares of the pairs of area lie.

    d_t(x, x') = (Σ_{i>0} e^{−2 λ_i t} (φ_i(x) − φ_i(x'))²)^½ (Coifman and Lafon 2006; Kovnatsky et al. 2011,
    equation 7, whose second line drops the 2). The distance is the mean over times of the product over
    operators (Kovnatsky et al., section 5): one operator is the geometric case, one for each η the joint one.

    Parameters
    ----------
    spectra : sequence of (eigenvalues (k,), eigenfunctions (s, k))
        At the sampled points, one for each η; eigenvalues ascend.
    times : tuple of float
        t, squared units.
    areas : (s,) array
        Area that each sample stands for; a pair weighs the product of two, each point with itself included.
    n_levels : int
        Levels (i + ½) / n_levels.

    Returns
    -------
    (n_levels,) array
        Ascending: the inverse of the cumulative distribution F, in 1 / units to the power of the operators.
    """
    shares = areas / areas.sum()
    systems = [[_coordinates(*spectrum, time) for spectrum in spectra] for time in times]
    longest = sum(np.prod([2.0 * norms.max() ** 0.5 for _, _, norms in of_time]) for of_time in systems)
    if longest == 0.0:
        return np.zeros(n_levels)
    lowest = max((int(np.float32(longest).view(np.int32)) >> (23 - SHARPNESS)) + 2 - FINE_BINS, 0)
    counts = np.zeros(FINE_BINS)
    for start, block in _blocks(systems):
        _count(block.view(np.int32), shares[start:], lowest, counts)
    counts[0] += shares @ shares
    cumulative = np.concatenate([[0.0], np.cumsum(counts)])
    levels = (np.arange(n_levels) + 0.5) / n_levels
    edges = ((np.arange(FINE_BINS + 1) + lowest) << (23 - SHARPNESS)).astype(np.int32).view(np.float32)
    edges[0] = 0.0
    return np.interp(levels, cumulative, edges / len(times))


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


def _blocks(systems: list[list[Coordinates]]) -> Iterator[tuple[int, SingleArray]]:
    """Yield the first row of each block and its distances times the number of times, (≤ ROWS, s − start).

    Systems of coordinates are listed by time, and then by operator.
    """
    all_norms = [np.stack([norms for _, _, norms in of_time]) for of_time in systems]  # (operators, s) each
    n_operators, n_points = all_norms[0].shape
    buffer = np.empty((n_operators + 1) * ROWS * n_points, np.float32)
    for start in range(0, n_points, ROWS):
        rows, shape = slice(start, start + ROWS), (min(ROWS, n_points - start), n_points - start)
        distances, *products = buffer[: (n_operators + 1) * shape[0] * shape[1]].reshape(-1, *shape)
        distances[:] = 0.0
        for of_time, norms in zip(systems, all_norms, strict=True):
            for (points, transposed, _), product in zip(of_time, products, strict=True):
                np.matmul(points[rows], transposed[:, start:], out=product)
            _add(buffer[shape[0] * shape[1] :], norms[:, start:].copy(), distances)
        yield start, distances


@compiled
def _add(products: SingleArray, norms: SingleArray, distances: SingleArray) -> None:
    """Add the roots of the products over operators of ‖x‖² + ‖x'‖² − 2 x·x', in place.

    Parameters
    ----------
    products : (operators · r · c,) array
        −2 x·x'; overwritten. More may follow.
    norms : (operators, c) array
        Of the columns, of which the first r are the rows.
    distances : (r, c) array
    """
    n_rows, n_columns = distances.shape
    zero = np.float32(0.0)
    for i in range(n_rows):
        line = products[i * n_columns : (i + 1) * n_columns]
        for factor in range(len(norms)):
            begin = (factor * n_rows + i) * n_columns
            row, of_row, own = products[begin : begin + n_columns], norms[factor], norms[factor, i]
            for j in range(n_columns):
                square = row[j] + (of_row[j] + own)
                square = square if square > zero else zero
                line[j] = square if factor == 0 else line[j] * square
        for j in range(n_columns):
            distances[i, j] += np.sqrt(line[j])


@compiled
def _count(bits: IntArray, shares: FloatArray, lowest: int, counts: FloatArray) -> None:
    """Add the pairs right of the diagonal to a histogram, each of them twice.

    Bits of positive single numbers, read as an integer, ascend with them: first exponent, then digits.
    """
    n_rows, n_columns = bits.shape
    for i in range(n_rows):
        own = 2.0 * shares[i]
        for j in range(i + 1, n_columns):
            counts[max((bits[i, j] >> (23 - SHARPNESS)) - lowest, 0)] += own * shares[j]


def _coordinates(eigenvalues: FloatArray, eigenfunctions: FloatArray, time: float) -> Coordinates:
    """Return points (s, k) whose distances are d_t, −2 times those (k, s), and squared norms (s,)."""
    decay = np.exp(-eigenvalues * time)
    kept = decay >= FADED * decay[:2].min(initial=1.0)  # the first is that of a constant
    coordinates = eigenfunctions[:, kept] * decay[kept]  # constant functions cancel in the differences
    coordinates = (coordinates - coordinates.mean(axis=0)).astype(np.float32)
    norms = np.square(coordinates).sum(axis=1)
    return coordinates, np.ascontiguousarray(np.float32(-2.0) * coordinates.T), norms
