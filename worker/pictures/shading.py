"""Light on a surface: normals that are smooth where the surface is, and a lamp over the left shoulder."""

import numpy as np

from worker.arrays import FloatArray, IntArray
from worker.geometry.areas import face_vectors, unit, vertex_normals

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
    vectors = face_vectors(vertices, faces)  # (m, 3)
    smooth = vertex_normals(vertices, faces)
    named = np.zeros(len(faces), dtype=np.bool_)
    named[chosen] = True
    distinct = np.flatnonzero(named)  # a face is seen at many pixels
    own, around = unit(vectors[distinct])[:, None], smooth[faces[distinct]]  # (d, 1, 3), (d, 3, 3)
    sharp = (own * around).sum(-1, keepdims=True) < CREASE
    normals = np.where(sharp, own, around)
    return np.asarray(normals[(np.cumsum(named) - 1)[chosen]])


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
    right, up, towards = (unit(normals) @ axes.T).T  # each (k,)
    sides = np.where(towards < 0, -1.0, 1.0)
    lamp = LAMP / np.linalg.norm(LAMP)
    facing = sides * (right * lamp[0] + up * lamp[1] + towards * lamp[2])
    lit = np.clip((facing + WRAP) / (1 + WRAP), 0.0, 1.0)
    brightness = AMBIENT + SKY * sides * up + (1.04 - AMBIENT) * lit
    return np.asarray(np.clip(colours * brightness[:, None], 0.0, 1.0))
