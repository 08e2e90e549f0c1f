"""The small eigenvalues of a Laplacian, all of them, and their eigenfunctions."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy import linalg, sparse
from scipy.sparse import csgraph
from scipy.sparse.linalg import SuperLU, splu

from worker.arrays import FloatArray, IntArray
from worker.errors import Code, MeshError
from worker.geometry.lanczos import dominant_vectors

DENSE = 400  # connected pieces of no more vertices are solved densely
CROWDED = 0.2  # of all pairs wanted: from here a piece is solved densely as well
NUDGES = 8  # times that the cutoff or the shift is moved by a little where it hits an eigenvalue
LOWERINGS = 8  # times that the cutoff is lowered where more pairs than the cap lie below it
SPARE = 1.2  # how many times the cap may lie below it


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
    wanted = 0
    if len(mass) > DENSE:
        cutoff, wanted = _count_few(stiffness, mass, cutoff, most)
    if len(mass) <= DENSE or wanted > CROWDED * len(mass):
        symmetric = scale[:, None] * stiffness.toarray() * scale
        values, vectors = linalg.eigh(symmetric, subset_by_value=(-np.inf, cutoff))
    else:
        symmetric = _scaled(stiffness, scale)
        values, vectors = _solve_sparse(symmetric, cutoff, wanted)
        _set_constant(symmetric, np.sqrt(mass), values, vectors)
    values, vectors = values[:most], scale[:, None] * vectors[:, :most]
    return np.maximum(values, 0.0), _fix_signs(vectors, mass)


def _scaled(stiffness: sparse.csc_array, scale: FloatArray) -> sparse.csc_array:
    """Multiply rows and columns of W by the entries of A^-½: the same eigenvalues, without A."""
    factors = scale[stiffness.indices] * np.repeat(scale, np.diff(stiffness.indptr))
    parts = (stiffness.data * factors, stiffness.indices, stiffness.indptr)
    return sparse.csc_array(parts, shape=stiffness.shape)


def _count_few(stiffness: sparse.csc_array, mass: FloatArray, cutoff: float, most: int) -> tuple[float, int]:
    """Lower a cutoff until not many more than the cap lie below it; return it, and how many do."""
    count, lower = count_below(stiffness, mass, cutoff), 0.0
    for _ in range(LOWERINGS):
        if count <= SPARE * most:
            break
        trial = max(cutoff * SPARE * most / count, (lower + cutoff) / 2)  # Weyl (1911): they grow evenly
        fewer = count_below(stiffness, mass, trial)
        if fewer < most:
            lower = trial
        else:
            cutoff, count = trial, fewer
    return cutoff, count


def _solve_sparse(symmetric: sparse.csc_array, cutoff: float, n_pairs: int) -> tuple[FloatArray, FloatArray]:
    """Find the pairs below a cutoff, known to be so many, by inverse iteration about its half.

    All of them are nearer to it than any other. Rayleigh-Ritz values bound the true ones from above
    (Parlett 1980, section 10.1): so many below the cutoff are all that there are.
    """
    n = symmetric.shape[0]
    for nudge in range(NUDGES):
        shift = cutoff * (0.5 - 0.01 * nudge)
        factors = _factor(symmetric, np.ones(n), shift)
        if factors is None:
            continue
        span = dominant_vectors(factors.solve, n, n_pairs, 1.0 / (cutoff - shift))  # (n_pairs, n)
        if span is not None:
            values, turns = linalg.eigh(span @ (symmetric @ span.T))
            if values.max(initial=0.0) <= cutoff * (1.0 + 1e-9):
                return values, span.T @ turns
    raise MeshError(Code.UNSOLVED, f"{n_pairs} vibration modes were expected, and not all found.")


def _set_constant(
    symmetric: sparse.csc_array, constant: FloatArray, values: FloatArray, vectors: FloatArray
) -> None:
    """Make the constant function exact, in place: on small pieces late heat differs from it by 1e-12 only."""
    constant = constant / np.linalg.norm(constant)
    if np.abs(symmetric @ constant).max() < 1e-12 * symmetric.diagonal().max():  # no vertex was left out
        values[:1] = 0.0
        vectors -= np.outer(constant, constant @ vectors)
        vectors[:, :1] = constant[:, None]


def _factor(stiffness: sparse.csc_array, mass: FloatArray, shift: float) -> SuperLU | None:
    """Factor W − shift A keeping its symmetry; None where a pivot is 0."""
    matrix = sparse.csc_array(stiffness - shift * sparse.diags_array(mass))
    try:
        return splu(
            matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
        )
    except RuntimeError:
        return None


def _fix_signs(vectors: FloatArray, mass: FloatArray) -> FloatArray:
    """Choose the sign of each eigenfunction: its third moment is not negative."""
    moments = mass @ (vectors * vectors * vectors)
    return vectors * np.where(moments < 0, -1.0, 1.0)
