"""Light on a surface: normals that are smooth where the surface is, and a lamp over the left shoulder."""

import numpy as np

from worker.arrays import FloatArray, IntArray

CREASE = 0.75  # cosine of the turn beyond which an edge is shown as sharp
LAMP = np.array([-0.45, 0.65, 0.85])  # direction to the light: right, up, towards the camera
WRAP = 0.25  # how far the light reaches around the surface
AMBIENT = 0.62  # brightness that reaches every point
SKY = 0.1  # more of it from above, less from below


def corner_normals(vertices: FloatArray, faces: IntArray, chosen: IntArray) -> FloatArray:
    """Return a unit normal at each corner of the chosen triangles.

    Parameters
    ----------
    vertices : (n, 3) array
    faces : (m, 3) array
    chosen : (k,) array
        Indices of faces.

    Returns
    -------
    (k, 3, 3) array
        The area-weighted mean around the vertex, or the triangle's own normal beyond a crease.
    """
    a, b, c = (vertices[column] for column in faces.T)
    across = np.cross(b - a, c - a)  # (m, 3)
    sums = np.zeros(vertices.shape)
    for k in range(3):
        sums[:, k] = np.bincount(faces.ravel(), across[:, k].repeat(3), len(vertices))
    own, smooth = _unit(across[chosen])[:, None], _unit(sums)[faces[chosen]]  # (k, 1, 3), (k, 3, 3)
    sharp = (own * smooth).sum(-1, keepdims=True) < CREASE
    return np.where(sharp, own, smooth)


def shade(colours: FloatArray, normals: FloatArray, axes: FloatArray) -> FloatArray:
    """Light colours.

    Parameters
    ----------
    colours : (k, 3) array
        sRGB in 0…1.
    normals : (k, 3) array
        Of any length; turned towards the camera where they look away.
    axes : (3, 3) array
        Rows: right, up, towards the camera.

    Returns
    -------
    (k, 3) array
        sRGB in 0…1.
    """
    seen = _unit(normals) @ axes.T  # (k, 3)
    seen = np.where(seen[:, 2:] < 0, -seen, seen)
    lit = np.clip((seen @ (LAMP / np.linalg.norm(LAMP)) + WRAP) / (1 + WRAP), 0.0, 1.0)
    brightness = AMBIENT + SKY * seen[:, 1] + (1.04 - AMBIENT) * lit
    return np.asarray(np.clip(colours * brightness[:, None], 0.0, 1.0))


def _unit(vectors: FloatArray) -> FloatArray:
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.asarray(vectors / np.maximum(lengths, np.finfo(np.float64).tiny))
