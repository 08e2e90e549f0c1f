"""Block Lanczos iteration: the dominant eigenpairs of a symmetric operator.

Golub and Underwood (1977); several vectors are taken at once, since a factorised matrix solves several right
hand sides in little more time than one. Blocks are orthogonal to the two before them by construction;
orthogonality to all others decays over some steps (Paige 1971) and is restored for two blocks at a time,
before it has lost more than four digits (Grcar 1981; Simon 1984).
"""

from collections.abc import Callable

import numpy as np
from scipy import linalg

from worker.arrays import FloatArray
from worker.geometry.substitution import SIDES

BLOCK = SIDES  # vectors of a step
PERIOD = 3  # steps from one restoration to the next
EVERY = 2  # steps from one look at the convergence to the next
TOLERANCE = 1e-7  # of a residual, relative to the least eigenvalue wanted
SKEWED = 1e-8  # the scalar product of two vectors found from which orthogonality counts as lost
SEED = 2011  # of the first vectors


def dominant_pairs(
    operator: Callable[[FloatArray], FloatArray], n_rows: int, n_pairs: int, least: float
) -> tuple[FloatArray, FloatArray] | None:
    """Find the eigenvalues greatest in modulus and their eigenvectors.

    Parameters
    ----------
    operator : callable
        Takes vectors (BLOCK, n_rows), one a row, to its products with them.
    n_rows : int
        Order of the operator.
    n_pairs : int
        How many eigenvalues are known to have at least the modulus `least`; all of them are waited for.
    least : float

    Returns
    -------
    values : (n_pairs,) array
    vectors : (n_pairs, n_rows) array
        Rows, orthonormal. None in place of both where they were not found in time.
    """
    most = min(n_rows - BLOCK, 8 * n_pairs + 20 * BLOCK)
    basis = np.empty((most + BLOCK, n_rows))  # one vector a row
    projected = np.zeros((most + BLOCK, most + BLOCK))  # the operator in the basis, its upper triangle
    first = np.random.default_rng(SEED).standard_normal((BLOCK, n_rows))
    basis[:BLOCK] = _orthonormal_rows(_orthonormal_rows(first)[0])[0]
    look = 1.5 * n_pairs + 8 * BLOCK  # seldom enough
    for size in range(BLOCK, most + 1, BLOCK):  # of the basis
        coupling = _extend(operator, basis, projected, size)
        if size // BLOCK % PERIOD == 0 or size + BLOCK > most:
            _restore(basis[: size - BLOCK], basis[size - BLOCK : size + BLOCK])
        if size < min(look, most - BLOCK):
            continue
        look = size + EVERY * BLOCK
        values, vectors = linalg.eigh(projected[:size, :size], lower=False, check_finite=False)
        chosen = np.argsort(-np.abs(values), kind="stable")[:n_pairs]
        residuals = np.linalg.norm(coupling @ vectors[-BLOCK:, chosen], axis=0)
        found = np.abs(values[chosen]).min(initial=np.inf) >= least * (1.0 - TOLERANCE)
        if found and residuals.max(initial=0.0) <= TOLERANCE * least:
            rows = vectors[:, chosen].T @ basis[:size]
            skew = np.abs(rows @ rows.T - np.eye(n_pairs)).max(initial=0.0)
            return (values[chosen], rows) if skew < SKEWED else None
    return None


def _extend(
    operator: Callable[[FloatArray], FloatArray], basis: FloatArray, projected: FloatArray, size: int
) -> FloatArray:
    """Add the next block to a basis of some size; return its coupling (BLOCK, BLOCK) to the last one."""
    last, near = slice(size - BLOCK, size), slice(max(size - 2 * BLOCK, 0), size)
    block = operator(basis[last])  # (BLOCK, n)
    products = basis[near] @ block.T
    projected[near, last] = products
    block, inner = _orthonormal_rows(block - products.T @ basis[near])
    block -= (basis[near] @ block.T).T @ basis[near]
    basis[size : size + BLOCK], outer = _orthonormal_rows(block)
    return np.asarray((inner @ outer).T)


def _restore(basis: FloatArray, blocks: FloatArray) -> None:
    """Make the last two blocks orthogonal to all of a basis and to each other, in place."""
    blocks -= (basis @ blocks.T).T @ basis
    first, second = blocks[:BLOCK], blocks[BLOCK:]
    first[:] = _orthonormal_rows(first)[0]
    second -= (first @ second.T).T @ first
    second[:] = _orthonormal_rows(second)[0]


def _orthonormal_rows(rows: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Factor rows as a lower triangular matrix times orthonormal rows; return rows and matrix.

    By Cholesky, which leaves an error of the square of their condition: callers do it twice.
    """
    try:
        factor = np.linalg.cholesky(rows @ rows.T)
    except np.linalg.LinAlgError:  # linearly dependent rows; any others may stand in for those
        columns, upper = np.linalg.qr(rows.T)
        return columns.T, upper.T
    return np.linalg.inv(factor) @ rows, np.asarray(factor)
