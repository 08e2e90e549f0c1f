"""Gradients and Hessians of functions on a triangulated surface."""

import numpy as np
from scipy.sparse import coo_array, csr_array

from worker.arrays import FloatArray, IntArray
from worker.geometry.areas import face_vectors, unit


def gradient_operator(vertices: FloatArray, faces: IntArray) -> csr_array:
    """Return the matrix that takes a function at the vertices to its surface gradient there.

    In a face the linear interpolant has the gradient Σ_i f_i N × e_i / 2A, where e_i is the edge opposite
    corner i (Botsch et al. (2010), Polygon Mesh Processing, section 3.3.3); a vertex takes the mean over its
    faces, weighted by area. Exact for linear functions on a plane, at its border too.

    Parameters
    ----------
    vertices : (n, 3) array
    faces : (m, 3) array
        Edges may be shared by any number of them.

    Returns
    -------
    (3 n, n) matrix
        Row 3 i + c is component c at vertex i, in units of the function per unit of length; 0 where a vertex
        has no face.
    """
    n_vertices, corners = len(vertices), vertices[faces]
    vectors = face_vectors(vertices, faces)
    opposite = np.roll(corners, -2, axis=1) - np.roll(corners, -1, axis=1)  # (m, 3, 3), edge by corner
    slopes = np.cross(unit(vectors)[:, None], opposite) / 2.0  # (m, 3, 3), gradient of each hat times A
    areas = np.repeat(np.linalg.norm(vectors, axis=1), 3)
    around = np.bincount(faces.ravel(), areas, n_vertices)  # (n,)
    shares = slopes[:, None] / np.where(around > 0, around, 1.0)[faces][:, :, None, None]  # (m, at, from, 3)
    rows = np.broadcast_to(3 * faces[:, :, None, None] + np.arange(3), shares.shape)
    columns = np.broadcast_to(faces[:, None, :, None], shares.shape)
    entries = (shares.ravel(), (rows.ravel(), columns.ravel()))
    return coo_array(entries, shape=(3 * n_vertices, n_vertices)).tocsr()


def gradients(operator: csr_array, values: FloatArray) -> FloatArray:
    """Apply a `gradient_operator` to a function (n,); (n, 3)."""
    return np.asarray(operator @ values).reshape(-1, 3)


def tangent_hessians(
    operator: csr_array, values: FloatArray, normals: FloatArray, chosen: IntArray | None = None
) -> FloatArray:
    """Return the second derivatives of a function along the surface.

    The covariant derivative of the gradient: differentiate its components in space, keep what lies in the
    tangent plane, make it symmetric.

    Parameters
    ----------
    operator : (3 n, n) matrix
        From `gradient_operator`.
    values : (n,) array
    normals : (n, 3) array
        Unit normals at the vertices.
    chosen : (k,) array, optional
        Vertices where they are wanted; everywhere without it.

    Returns
    -------
    (k, 2, 2) array
        In some orthonormal basis of each tangent plane; eigenvalues do not depend on which.
    """
    derivatives = np.asarray(operator @ gradients(operator, values)).reshape(-1, 3, 3)
    if chosen is not None:
        derivatives, normals = derivatives[chosen], normals[chosen]
    bases = tangent_bases(normals)  # (k, 2, 3)
    hessians = bases @ derivatives @ bases.transpose(0, 2, 1)
    return np.asarray((hessians + hessians.transpose(0, 2, 1)) / 2.0)


def tangent_bases(normals: FloatArray) -> FloatArray:
    """Return two orthonormal vectors across each unit normal (n, 3), turning left around it; (n, 2, 3)."""
    across = np.eye(3)[np.argmin(np.abs(normals), axis=1)]
    first = unit(np.cross(normals, across))
    return np.stack([first, np.cross(normals, first)], axis=1)
