"""Which faces to turn, so that neighbours agree on what is outside."""

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from worker.arrays import BoolArray, IntArray


def face_edges(faces: IntArray) -> IntArray:
    """Return the directed edges of faces (m, 3): first edges, then second, then third ones, (3m, 2)."""
    return np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])


def undirected(edges: IntArray) -> IntArray:
    """Return one number for each edge (k, 2), the same in both directions: (k,)."""
    most = int(edges.max(initial=0)) + 1
    numbers: IntArray = edges.min(axis=1) * most + edges.max(axis=1)
    return numbers


def flipped_faces(faces: IntArray) -> tuple[BoolArray, bool]:
    """Return which faces to turn.

    Every face stands twice in a graph, as it is and turned. Where two faces meet along an edge, copies
    that agree are connected: the faces of one orientable piece fall into two mirrored sets, of which
    the one with more faces as they are is taken. Where they fall into one set (a Möbius strip),
    the piece stays as it is.

    Parameters
    ----------
    faces : IntArray
        (m, 3); edges of more than two faces connect nothing.

    Returns
    -------
    flipped : BoolArray
        (m,)
    orientable : bool
        Whether every piece could be oriented.
    """
    n_faces = len(faces)
    first, second, agree = _neighbours(faces)
    other = second + np.where(agree, 0, n_faces)  # the copy of `second` that agrees with `first` as it is
    mirrored = second + np.where(agree, n_faces, 0)
    starts, ends = np.concatenate([first, first + n_faces]), np.concatenate([other, mirrored])
    graph = coo_array((np.ones(starts.size, dtype=np.int8), (starts, ends)), shape=(2 * n_faces, 2 * n_faces))
    n_sets, labels = connected_components(graph, directed=False)
    as_is, turned = labels[:n_faces], labels[n_faces:]
    sizes = np.bincount(as_is, minlength=n_sets)  # faces as they are in each set
    # Of two sets of equal size the one with the lower number wins, which holds the first face as it is.
    flipped: BoolArray = (sizes[turned] > sizes[as_is]) | ((sizes[turned] == sizes[as_is]) & (turned < as_is))
    return flipped, bool((as_is != turned).all())


def _neighbours(faces: IntArray) -> tuple[IntArray, IntArray, BoolArray]:
    """Return the pairs of faces that share an edge of exactly two, and whether they agree: (p,) each."""
    edges = face_edges(faces)
    owners = np.tile(np.arange(len(faces)), 3)
    ascending = edges[:, 0] < edges[:, 1]
    keys = undirected(edges)
    order = np.argsort(keys, kind="stable")
    starts = np.flatnonzero(np.diff(keys[order], prepend=-1, append=-1))
    pairs = starts[:-1][np.diff(starts) == 2]  # first of two equal edges
    one, two = order[pairs], order[pairs + 1]
    return owners[one], owners[two], ascending[one] != ascending[two]
