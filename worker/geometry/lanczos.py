"""Block Lanczos iteration: the dominant eigenvectors of a symmetric operator.

Golub and Underwood (1977); several vectors are taken at once, since a factorised matrix solves several right
hand sides in little more time than one, and orthogonality is restored in full at each step.
"""

from collections.abc import Callable

import numpy as np
from scipy import linalg

from worker.arrays import FloatArray

BLOCK = 4  # vectors of a step
EVERY = 2  # steps from one look at the convergence to the next
TOLERANCE = 1e-9  # of a residual, relative to the least eigenvalue wanted
SEED = 2011  # of the first vectors


def dominant_vectors(
    operator: Callable[[FloatArray], FloatArray], n_rows: int, n_pairs: int, least: float
) -> FloatArray | None:
    """Find the eigenvectors of the eigenvalues greatest in modulus.

    Parameters
    ----------
    operator : callable
        Takes (n_rows, BLOCK) columns to its products with them.
    n_rows : int
        Order of the operator.
    n_pairs : int
        How many eigenvalues are known to have at least the modulus `least`; all of them are waited for.
    least : float

    Returns
    -------
    (n_pairs, n_rows) array, or None
        Rows span the invariant subspace, orthonormal; None where it was not found in time.
    """
    most = min(n_rows - BLOCK, 8 * n_pairs + 20 * BLOCK)
    basis = np.empty((most + BLOCK, n_rows))  # one vector a row
    projected = np.zeros((most + BLOCK, most + BLOCK))  # the operator in the basis, its upper triangle
    first = np.random.default_rng(SEED).standard_normal((BLOCK, n_rows))
    basis[:BLOCK] = _orthonormal_rows(_orthonormal_rows(first)[0])[0]
    for size in range(BLOCK, most + 1, BLOCK):  # of the basis
        coupling = _extend(operator, basis, projected, size)
        if size < 2 * n_pairs or size // BLOCK % EVERY:
            continue
        values, vectors = linalg.eigh(projected[:size, :size], lower=False, check_finite=False)
        chosen = np.argsort(-np.abs(values), kind="stable")[:n_pairs]
        residuals = np.linalg.norm(coupling @ vectors[-BLOCK:, chosen], axis=0)
        found = np.abs(values[chosen]).min(initial=np.inf) >= least * (1.0 - TOLERANCE)
        if found and residuals.max(initial=0.0) <= TOLERANCE * least:
            return np.asarray(vectors[:, chosen].T @ basis[:size])
    return None


def _extend(
    operator: Callable[[FloatArray], FloatArray], basis: FloatArray, projected: FloatArray, size: int
) -> FloatArray:
    """Add the next block to a basis of some size; return its coupling (BLOCK, BLOCK) to the last one."""
    last, near = slice(size - BLOCK, size), slice(max(size - 2 * BLOCK, 0), size)
    block = operator(basis[last].T).T  # (BLOCK, n)
    products = basis[near] @ block.T
    projected[near, last] = products
    block, inner = _orthonormal_rows(block - products.T @ basis[near])
    block -= (basis[:size] @ block.T).T @ basis[:size]
    basis[size : size + BLOCK], outer = _orthonormal_rows(block)
    return np.asarray((inner @ outer).T)


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
