"""The small eigenvalues of a Laplacian, all of them, and their eigenfunctions."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from itertools import pairwise

import numpy as np
from scipy import linalg, sparse
from scipy.sparse import csgraph

from worker.arrays import FloatArray, IntArray
from worker.errors import Code, MeshError
from worker.geometry.factors import Factors, factorise
from worker.geometry.fronts import Fronts, find_fronts
from worker.geometry.lanczos import dominant_pairs
from worker.geometry.substitution import solve

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


@dataclass(frozen=True, kw_only=True, eq=False)
class System:
    """A symmetric matrix and what its factorisations share."""

    matrix: sparse.csc_array  # (n, n), A^-½ W A^-½: the eigenvalues of W φ = λ A φ
    diagonal: FloatArray  # (n,)
    starts: IntArray  # (n + 1,), where each column begins
    rows: IntArray  # of the entries, by columns
    fronts: Fronts

    def factorise(self, shift: float) -> Factors | None:
        """Factor the matrix less a multiple of the identity; None where that is singular."""
        return factorise(self.fronts, self.starts, self.rows, self.matrix.data, self.diagonal - shift)


def solve_eigenpairs(
    points: FloatArray, stiffness: sparse.csc_array, mass: FloatArray, cutoff: float, most: int = 200
) -> Eigenpairs:
    """Find every eigenpair below a cutoff.

    Each connected piece is solved by itself, so that many pieces cannot hide one another's pairs. How many
    there are is known beforehand, from the inertia of W − cutoff A (Sylvester's law; Parlett 1980, section
    3.3).

    Parameters
    ----------
    points : (n, d ≥ 3) array
        Where the vertices lie; it decides in which order they are eliminated, and nothing else.
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
    solved = [
        (rows, *_solve_piece(points[rows], piece, mass[rows], cutoff, most))
        for rows, piece in pieces_of(stiffness, mass)
    ]
    return _joined(solved, len(mass))


def pieces_of(stiffness: sparse.csc_array, mass: FloatArray) -> Iterator[tuple[IntArray, sparse.csc_array]]:
    """Yield the rows and the matrix of each connected piece, without vertices that have no area."""
    for rows, piece in _pieces(stiffness):
        massive = np.flatnonzero(mass[rows] > 0)
        if len(massive) == len(rows):
            yield rows, piece
        elif len(massive):
            yield rows[massive], sparse.csc_array(piece[massive][:, massive])


def _pieces(stiffness: sparse.csc_array) -> Iterator[tuple[IntArray, sparse.csc_array]]:
    """Yield the rows and the matrix of each connected piece."""
    n_pieces, pieces = csgraph.connected_components(stiffness, directed=False)
    if n_pieces == 1:
        yield np.arange(len(pieces)), stiffness
        return
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
    eigenfunctions = np.zeros((len(eigenvalues), n_vertices))
    start = 0
    for rows, values, functions in solved:
        for place, function in zip(places[start:], functions, strict=False):
            eigenfunctions[place, rows] = function
        start += len(values)
    return Eigenpairs(
        eigenvalues=np.sort(eigenvalues, kind="stable"), eigenfunctions=np.ascontiguousarray(eigenfunctions.T)
    )


def system_of(points: FloatArray, stiffness: sparse.csc_array, mass: FloatArray) -> System:
    """Prepare the factorisations of W − σ A; A has no 0 on its diagonal, else as for `solve_eigenpairs`."""
    scale = 1.0 / np.sqrt(mass)
    starts, rows = stiffness.indptr.astype(np.int64), stiffness.indices.astype(np.int64)
    weights = stiffness.data * (scale[rows] * np.repeat(scale, np.diff(starts)))
    matrix = sparse.csc_array((weights, rows, starts), shape=stiffness.shape)
    return System(
        matrix=matrix,
        diagonal=matrix.diagonal(),
        starts=starts,
        rows=rows,
        fronts=find_fronts(points, starts, rows),
    )


def count_below(system: System, value: float) -> int:
    """Count the eigenvalues below a value: the negative pivots of a factorisation.

    Raises
    ------
    MeshError
        ``unsolved`` where no factorisation without row exchanges was found close to the value.
    """
    for nudge in range(NUDGES):
        factors = system.factorise(value * (1.0 - 1e-10 * (8.0**nudge - 1.0)))
        if factors is not None:
            return factors.negative
    raise MeshError(Code.UNSOLVED, "The number of the shape's vibration modes could not be proven.")


def _solve_piece(
    points: FloatArray, stiffness: sparse.csc_array, mass: FloatArray, cutoff: float, most: int
) -> tuple[FloatArray, FloatArray]:
    """Solve one connected piece; (k,) and (k, n)."""
    scale, wanted = 1.0 / np.sqrt(mass), 0
    if len(mass) > DENSE:
        system = system_of(points, stiffness, mass)
        cutoff, wanted = _count_few(system, cutoff, most)
    if len(mass) <= DENSE or wanted > CROWDED * len(mass):
        symmetric = scale[:, None] * stiffness.toarray() * scale
        values, columns = linalg.eigh(symmetric, subset_by_value=(-np.inf, cutoff))
        vectors = np.ascontiguousarray(columns.T)
    else:
        values, vectors = _solve_sparse(system, cutoff, wanted)
        _set_constant(system.matrix, np.sqrt(mass), values, vectors)
    vectors = vectors[:most] * scale
    return np.maximum(values[:most], 0.0), _fix_signs(vectors, mass)


def _count_few(system: System, cutoff: float, most: int) -> tuple[float, int]:
    """Lower a cutoff until not many more than the cap lie below it; return it, and how many do."""
    count, lower = count_below(system, cutoff), 0.0
    for _ in range(LOWERINGS):
        if count <= SPARE * most:
            break
        trial = max(cutoff * SPARE * most / count, (lower + cutoff) / 2)  # Weyl (1911): they grow evenly
        fewer = count_below(system, trial)
        if fewer < most:
            lower = trial
        else:
            cutoff, count = trial, fewer
    return cutoff, count


def _solve_sparse(system: System, cutoff: float, n_pairs: int) -> tuple[FloatArray, FloatArray]:
    """Find the pairs below a cutoff, known to be so many, by inverse iteration about its half.

    All of them are nearer to it than any other. Each value found with a small residual, its vector
    orthogonal to the others', has an eigenvalue of its own beside it (Parlett 1980, section 11.5): so many
    are all that there are.
    """
    n = len(system.diagonal)
    for nudge in range(NUDGES):
        shift = cutoff * (0.5 - 0.01 * nudge)
        factors = system.factorise(shift)
        if factors is None:
            continue
        pairs = dominant_pairs(partial(solve, factors), n, n_pairs, 1.0 / (cutoff - shift))
        if pairs is not None:
            values = shift + 1.0 / pairs[0]
            order = np.argsort(values, kind="stable")
            return values[order], pairs[1][order]
    raise MeshError(Code.UNSOLVED, f"{n_pairs} vibration modes were expected, and not all found.")


def _set_constant(
    symmetric: sparse.csc_array, constant: FloatArray, values: FloatArray, vectors: FloatArray
) -> None:
    """Make the constant function exact, in place: on small pieces late heat differs from it by 1e-12 only."""
    constant = constant / np.linalg.norm(constant)
    if np.abs(symmetric @ constant).max() < 1e-12 * symmetric.diagonal().max():  # no vertex was left out
        values[:1] = 0.0
        vectors -= np.outer(vectors @ constant, constant)
        vectors[:1] = constant


def _fix_signs(vectors: FloatArray, mass: FloatArray) -> FloatArray:
    """Choose the sign of each eigenfunction: its third moment is not negative."""
    moments = (vectors * vectors * vectors) @ mass
    return vectors * np.where(moments < 0, -1.0, 1.0)[:, None]
