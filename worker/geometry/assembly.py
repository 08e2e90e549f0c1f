"""Laplacian matrices from the weights of edges."""

import numpy as np
from scipy import sparse

from worker.arrays import FloatArray, IntArray
from worker.compiled import compiled


def laplacian_of(tails: IntArray, heads: IntArray, weights: FloatArray, n_vertices: int) -> sparse.csc_array:
    """Return diag(Σ_j w_ij) − w for the symmetric w that has each weight between tail and head.

    Parameters
    ----------
    tails, heads : (e,) arrays
        Indices of vertices; the weights of the same two are added, those of a vertex to itself cancel.
    weights : (e,) array
    n_vertices : int

    Returns
    -------
    (n_vertices, n_vertices) sparse array
        Rows ascend in each column; a vertex without edges has its 0 on the diagonal.
    """
    values, rows, starts = _columns(tails, heads, weights, n_vertices)
    return sparse.csc_array((values, rows, starts), shape=(n_vertices, n_vertices))


@compiled
def _columns(  # noqa: C901 - compiled: one loop, plainly
    tails: IntArray, heads: IntArray, weights: FloatArray, n: int
) -> tuple[FloatArray, IntArray, IntArray]:
    """Return values, rows and starts of the columns.

    Neighbours are listed for each vertex; each vertex in turn then enters the columns of those, so that rows
    ascend.
    """
    begins = np.zeros(n + 1, np.int64)
    for edge in range(len(tails)):
        begins[tails[edge] + 1] += 1
        begins[heads[edge] + 1] += 1
    for vertex in range(n):
        begins[vertex + 1] += begins[vertex]
    others, given, ends = np.empty(begins[n], np.int64), np.empty(begins[n]), begins[:n].copy()
    for edge in range(len(tails)):
        for vertex, other in ((tails[edge], heads[edge]), (heads[edge], tails[edge])):
            others[ends[vertex]], given[ends[vertex]] = other, weights[edge]
            ends[vertex] += 1
    rows, values = np.empty(begins[n] + n, np.int64), np.empty(begins[n] + n)
    firsts = begins[:n] + np.arange(n)
    ends, diagonal = firsts.copy(), np.zeros(n)
    for vertex in range(n):
        rows[ends[vertex]], values[ends[vertex]] = vertex, 0.0
        ends[vertex] += 1
        for k in range(begins[vertex], begins[vertex + 1]):
            other, end = others[k], ends[others[k]]
            if other == vertex:
                continue
            diagonal[other] += given[k]
            if end > firsts[other] and rows[end - 1] == vertex:
                values[end - 1] -= given[k]
            else:
                rows[end], values[end] = vertex, -given[k]
                ends[other] += 1
    starts, used = np.zeros(n + 1, np.int64), 0
    for vertex in range(n):
        for k in range(firsts[vertex], ends[vertex]):
            rows[used], values[used] = rows[k], values[k]
            if rows[k] == vertex:
                values[used] = diagonal[vertex]
            used += 1
        starts[vertex + 1] = used
    return values[:used].copy(), rows[:used].copy(), starts
