"""The small eigenvalues of a Laplacian, all of them, and their eigenfunctions."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy import linalg, sparse
from scipy.sparse import csgraph
from scipy.sparse.linalg import LinearOperator, SuperLU, eigsh, splu

from worker.arrays import FloatArray, IntArray
from worker.errors import Code, MeshError

SHIFT = -2e-3  # of the inverse iteration, just below the spectrum
DENSE = 400  # connected pieces of no more vertices are solved densely
NUDGES = 8  # times that the cutoff is moved by a little where it hits an eigenvalue
SEED = 2011  # of the first vector


@dataclass(frozen=True, kw_only=True, eq=False)
class Eigenpairs:
    """Solutions of W φ = λ A φ below a cutoff, by ascending λ."""

    eigenvalues: FloatArray  # (k,), 1 / squared units, not negative
    eigenfunctions: FloatArray  # (n, k), φᵀ A φ = I


def solve_eigenpairs(
    stiffness: sparse.csc_array, mass: FloatArray, cutoff: float, most: int = 200
) -> Eigenpairs:
    """Find every eigenpair below a cutoff.

    Each connected piece is solved by itself, so that many pieces cannot hide one another's pairs. How many
    there are is known beforehand, from the inertia of W − cutoff A (Sylvester's law; Parlett 1980, section
    3.3).

    Parameters
    ----------
    stiffness : (n, n) sparse array
        W, symmetric and positive semi-definite.
    mass : (n,) array
        Diagonal of A, not negative.
    cutoff : float
        Upper end of the wanted eigenvalues, in the units of λ.
    most : int
        Cap on the pairs of one connected piece: the smallest are kept.

    Returns
    -------
    Eigenpairs

    Raises
    ------
    MeshError
        ``unsolved`` where the pairs found are not as many as the inertia says.
    """
    solved = []
    for rows, piece in _pieces(stiffness):
        massive = np.flatnonzero(mass[rows] > 0)
        if len(massive) == 0:
            continue
        if len(massive) < len(rows):
            rows, piece = rows[massive], sparse.csc_array(piece[massive][:, massive])
        solved.append((rows, *_solve_piece(piece, mass[rows], cutoff, most)))
    return _joined(solved, len(mass))


def _pieces(stiffness: sparse.csc_array) -> Iterator[tuple[IntArray, sparse.csc_array]]:
    """Yield the rows and the matrix of each connected piece."""
    n_pieces, pieces = csgraph.connected_components(stiffness, directed=False)
    order = np.argsort(pieces, kind="stable")
    ends = np.concatenate([[0], np.cumsum(np.bincount(pieces, minlength=n_pieces))])
    blocks = sparse.csc_array(stiffness[order][:, order])  # block diagonal
    for start, end in pairwise(ends.tolist()):
        inside = slice(blocks.indptr[start], blocks.indptr[end])
        columns = blocks.indptr[start : end + 1] - blocks.indptr[start]
        block = (blocks.data[inside], blocks.indices[inside] - start, columns)
        yield order[start:end], sparse.csc_array(block, shape=(end - start, end - start))


def _joined(solved: list[tuple[IntArray, FloatArray, FloatArray]], n_vertices: int) -> Eigenpairs:
    """Put the pairs of the pieces (rows, eigenvalues, eigenfunctions) together, ascending."""
    eigenvalues = np.concatenate([values for _, values, _ in solved])
    places = np.argsort(np.argsort(eigenvalues, kind="stable"), kind="stable")
    eigenfunctions = np.zeros((n_vertices, len(eigenvalues)))
    start = 0
    for rows, values, functions in solved:
        columns = places[start : start + len(values)]
        eigenfunctions[np.ix_(rows, columns)] = functions
        start += len(values)
    return Eigenpairs(eigenvalues=np.sort(eigenvalues, kind="stable"), eigenfunctions=eigenfunctions)


def count_below(stiffness: sparse.csc_array, mass: FloatArray, value: float) -> int:
    """Count the eigenvalues below a value: the negative pivots of a factorisation of W − value A.

    Raises
    ------
    MeshError
        ``unsolved`` where no factorisation without row exchanges was found close to the value.
    """
    for nudge in range(NUDGES):
        factors = _factor(stiffness, mass, value * (1.0 - 1e-10 * nudge))
        if factors is not None and np.array_equal(factors.perm_r, factors.perm_c):
            return int(np.count_nonzero(factors.U.diagonal() < 0))
    raise MeshError(Code.UNSOLVED, "The number of the shape's vibration modes could not be proven.")


def _solve_piece(
    stiffness: sparse.csc_array, mass: FloatArray, cutoff: float, most: int
) -> tuple[FloatArray, FloatArray]:
    """Solve one connected piece; (k,) and (n, k)."""
    scale = 1.0 / np.sqrt(mass)
    if len(mass) <= DENSE:
        symmetric = scale[:, None] * stiffness.toarray() * scale
        values, vectors = linalg.eigh(symmetric, subset_by_value=(-np.inf, cutoff))
        values, vectors = values[:most], scale[:, None] * vectors[:, :most]
    else:
        wanted = min(count_below(stiffness, mass, cutoff), most)
        values, vectors = _solve_sparse(stiffness, mass, wanted)
        if wanted < most and (len(values) != wanted or values[-1] > cutoff):
            raise MeshError(Code.UNSOLVED, f"{wanted} vibration modes were expected, {len(values)} found.")
    return np.maximum(values, 0.0), _fix_signs(vectors, mass)


def _solve_sparse(
    stiffness: sparse.csc_array, mass: FloatArray, n_pairs: int
) -> tuple[FloatArray, FloatArray]:
    """Find the smallest pairs by Lanczos iteration on the inverse (Lehoucq, Sorensen and Yang 1998)."""
    factors = _factor(stiffness, mass, SHIFT)
    if factors is None:
        raise MeshError(Code.UNSOLVED, "The shape's Laplacian could not be factorised.")
    n = len(mass)
    inverse = LinearOperator((n, n), matvec=factors.solve, dtype=np.float64)
    start = np.random.default_rng(SEED).standard_normal(n)
    values, vectors = eigsh(
        stiffness, n_pairs, sparse.diags_array(mass), sigma=SHIFT, OPinv=inverse, v0=start, tol=0.0
    )
    ascending = np.argsort(values, kind="stable")
    return values[ascending], _orthonormal(vectors[:, ascending], mass)


def _factor(stiffness: sparse.csc_array, mass: FloatArray, shift: float) -> SuperLU | None:
    """Factor W − shift A keeping its symmetry; None where a pivot is 0."""
    matrix = sparse.csc_array(stiffness - shift * sparse.diags_array(mass))
    try:
        return splu(
            matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
        )
    except RuntimeError:
        return None


def _orthonormal(vectors: FloatArray, mass: FloatArray) -> FloatArray:
    """Remove what rounding left of φᵀ A φ − I; the span stays."""
    factor = linalg.cholesky(vectors.T @ (mass[:, None] * vectors), lower=False)
    return np.asarray(linalg.solve_triangular(factor, vectors.T, trans="T", lower=False).T)


def _fix_signs(vectors: FloatArray, mass: FloatArray) -> FloatArray:
    """Choose the sign of each eigenfunction: its third moment is not negative."""
    moments = np.sum(mass[:, None] * vectors**3, axis=0)
    return vectors * np.where(moments < 0, -1.0, 1.0)
