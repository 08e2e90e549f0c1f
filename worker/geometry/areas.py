"""Lengths, areas and normals of a triangulated surface."""

import numpy as np

from worker.arrays import FloatArray, IntArray
from worker.compiled import compiled


def edge_lengths(points: FloatArray, faces: IntArray) -> FloatArray:
    """Measure the edges of each face.

    Parameters
    ----------
    points : (n, d) array
        Vertices in any dimension: 3 for geometry, 6 for the joint embedding.
    faces : (m, 3) array
        Indices of vertices.

    Returns
    -------
    (m, 3) array
        Column i is the length from corner i to corner i + 1.
    """
    return _edge_lengths(np.ascontiguousarray(points, np.float64), np.ascontiguousarray(faces))


@compiled
def _edge_lengths(points: FloatArray, faces: IntArray) -> FloatArray:
    lengths = np.empty((len(faces), 3))
    for face in range(len(faces)):
        for corner in range(3):
            start, end, square = faces[face, corner], faces[face, (corner + 1) % 3], 0.0
            for axis in range(points.shape[1]):
                difference = points[end, axis] - points[start, axis]
                square += difference * difference
            lengths[face, corner] = np.sqrt(square)
    return lengths


def triangle_areas(lengths: FloatArray) -> FloatArray:
    """Return areas of triangles from their edge lengths.

    Heron's formula in the stable ordering of Kahan (2014), "Miscalculating Area and Angles of a Needle-like
    Triangle"; a triple that rounding has pushed past the triangle inequality has area 0.

    Parameters
    ----------
    lengths : (m, 3) array

    Returns
    -------
    (m,) array
    """
    c, b, a = np.sort(lengths, axis=1).T  # a ≥ b ≥ c
    product = (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c))
    return np.asarray(np.sqrt(np.maximum(product, 0.0)) / 4.0)


def vertex_areas(faces: IntArray, areas: FloatArray, n_vertices: int) -> FloatArray:
    """Give each vertex a third of the area of every face around it.

    Parameters
    ----------
    faces : (m, 3) array
    areas : (m,) array
        Areas of the faces.
    n_vertices : int

    Returns
    -------
    (n_vertices,) array
        Sums to the area of the surface.
    """
    return np.bincount(faces.ravel(), np.repeat(areas / 3.0, 3), n_vertices).astype(np.float64)


def face_vectors(vertices: FloatArray, faces: IntArray) -> FloatArray:
    """Return for each face its normal, as long as its area; (m, 3)."""
    first, second, third = (vertices.take(faces[:, corner], axis=0) for corner in range(3))
    return np.asarray(np.cross(second - first, third - first) / 2.0)


def vertex_normals(vertices: FloatArray, faces: IntArray) -> FloatArray:
    """Return unit normals at the vertices, weighted by area; 0 where the faces cancel; (n, 3)."""
    vectors = np.repeat(face_vectors(vertices, faces), 3, axis=0)  # (3 m, 3)
    sums = [np.bincount(faces.ravel(), axis, len(vertices)) for axis in vectors.T]
    return unit(np.stack(sums, axis=1).astype(np.float64))


def unit(vectors: FloatArray) -> FloatArray:
    """Scale vectors to length 1; those of length 0 stay; (n, d)."""
    lengths = norms(vectors)
    return np.asarray(vectors / np.where(lengths > 0, lengths, 1.0)[:, None])


def norms(vectors: FloatArray) -> FloatArray:
    """Return the lengths of vectors (…, d), (…): several times faster than numpy's for a small d."""
    squares = vectors[..., 0] * vectors[..., 0]
    for axis in range(1, vectors.shape[-1]):
        squares += vectors[..., axis] * vectors[..., axis]
    return np.asarray(np.sqrt(squares))
