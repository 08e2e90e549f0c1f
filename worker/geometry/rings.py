"""Neighbourhoods of vertices along the surface, ring by ring."""

import numpy as np
from scipy.sparse import coo_array, csr_array, diags_array

from worker.arrays import FloatArray, IntArray
from worker.geometry.edges import find_edges


def one_rings(faces: IntArray, n_vertices: int) -> csr_array:
    """Return the matrix that holds 1 for each vertex and each of its neighbours; (n, n), symmetric."""
    ends, own = find_edges(faces).ends, np.arange(n_vertices)
    rows = np.concatenate([ends[:, 0], ends[:, 1], own])
    columns = np.concatenate([ends[:, 1], ends[:, 0], own])
    return coo_array((np.ones(len(rows)), (rows, columns)), shape=(n_vertices, n_vertices)).tocsr()


def rings_covering(
    rings: csr_array, areas: FloatArray, centres: IntArray, area: float
) -> tuple[IntArray, IntArray]:
    """Take ring after ring around each centre until they cover an area.

    Parameters
    ----------
    rings : (n, n) matrix
        From `one_rings`.
    areas : (n,) array
        Area of each vertex's cell.
    centres : (f,) array
        Indices of vertices.
    area : float
        To be covered at least; a smaller connected piece is taken whole. One ring is always taken.

    Returns
    -------
    owners : (p,) array
        Positions in ``centres``, ascending.
    members : (p,) array
        Vertices of the owner's rings, the centre among them.
    """
    n_centres = len(centres)
    entries = (np.ones(n_centres), (np.arange(n_centres), centres))
    covers = coo_array(entries, shape=(n_centres, len(areas))).tocsr()
    covered, growing = areas[centres], np.ones(n_centres, dtype=np.bool_)
    while growing.any():
        covers = covers + diags_array(growing.astype(np.float64)) @ covers @ rings
        covers.data[:] = 1.0
        before, covered = covered, covers @ areas
        growing &= (covered < area) & (covered > before)
    return np.repeat(np.arange(n_centres), np.diff(covers.indptr)), covers.indices.astype(np.int64)
