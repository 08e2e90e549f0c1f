"""Light on a surface: normals that are smooth where the surface is, and a lamp over the left shoulder."""

import numpy as np

from worker.arrays import FloatArray, IntArray
from worker.compiled import compiled
from worker.geometry.areas import face_vectors, unit

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
    smooth = np.zeros_like(vertices)
    _add_around(vectors, faces, smooth)
    return _sharpened(vectors, unit(smooth), faces, chosen)


@compiled
def _add_around(vectors: FloatArray, faces: IntArray, sums: FloatArray) -> None:
    """Add the vector of each face to its three vertices."""
    for face in range(len(faces)):
        for corner in range(3):
            for axis in range(3):
                sums[faces[face, corner], axis] += vectors[face, axis]


@compiled
def _sharpened(vectors: FloatArray, smooth: FloatArray, faces: IntArray, chosen: IntArray) -> FloatArray:
    """Take the smooth normal at each corner of the chosen faces, or the face's own beyond a crease."""
    normals = np.empty((len(chosen), 3, 3))
    for place, face in enumerate(chosen):
        x, y, z = vectors[face, 0], vectors[face, 1], vectors[face, 2]
        length = np.sqrt(x * x + y * y + z * z)
        scale = 1.0 / length if length > 0.0 else 0.0
        for corner in range(3):
            u, v, w = smooth[faces[face, corner]]
            if scale * (x * u + y * v + z * w) < CREASE:
                u, v, w = scale * x, scale * y, scale * z
            normals[place, corner, 0], normals[place, corner, 1], normals[place, corner, 2] = u, v, w
    return normals


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
    return _lit(colours, normals, axes, LAMP / np.linalg.norm(LAMP))


@compiled
def _lit(colours: FloatArray, normals: FloatArray, axes: FloatArray, lamp: FloatArray) -> FloatArray:
    shaded = np.empty_like(colours)
    for place in range(len(colours)):
        x, y, z = normals[place]
        length = np.sqrt(x * x + y * y + z * z)
        scale = 1.0 / length if length > 0.0 else 0.0
        if axes[2, 0] * x + axes[2, 1] * y + axes[2, 2] * z < 0.0:
            scale = -scale
        right = scale * (axes[0, 0] * x + axes[0, 1] * y + axes[0, 2] * z)
        up = scale * (axes[1, 0] * x + axes[1, 1] * y + axes[1, 2] * z)
        towards = scale * (axes[2, 0] * x + axes[2, 1] * y + axes[2, 2] * z)
        facing = right * lamp[0] + up * lamp[1] + towards * lamp[2]
        lit = min(max((facing + WRAP) / (1.0 + WRAP), 0.0), 1.0)
        brightness = AMBIENT + SKY * up + (1.04 - AMBIENT) * lit
        for channel in range(3):
            shaded[place, channel] = min(max(colours[place, channel] * brightness, 0.0), 1.0)
    return shaded
