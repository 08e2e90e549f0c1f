"""Values at points of triangles, and texels of images."""

import numpy as np

from worker.arrays import ByteArray, FloatArray, IntArray
from worker.compiled import compiled


@compiled
def interpolate(corners: FloatArray, faces: IntArray, shares: FloatArray) -> FloatArray:
    """Mix the values at the corners of triangles.

    Parameters
    ----------
    corners : (m, 3, d) array
    faces : (k,) array
        The triangle of each point.
    shares : (k, 3) array
        Its barycentric coordinates there.

    Returns
    -------
    (k, d) array
    """
    values = np.empty((len(faces), corners.shape[2]))
    for point, face in enumerate(faces):
        for column in range(corners.shape[2]):
            total = 0.0
            for corner in range(3):
                total += shares[point, corner] * corners[face, corner, column]
            values[point, column] = total
    return values


@compiled
def levels_of(corner_uvs: FloatArray, faces: IntArray, footprints: FloatArray, n_texels: int) -> IntArray:
    """Return the level of the image pyramid whose texels are about as large as each point's footprint.

    Parameters
    ----------
    corner_uvs : (m, 3, 2) array
    faces : (k,) array
    footprints : (k,) array
        Shares of the triangles' areas.
    n_texels : int
        Of the whole image.

    Returns
    -------
    (k,) array
        0 is the image itself, 1 half of it.
    """
    levels = np.empty(len(faces), dtype=np.int64)
    for point, face in enumerate(faces):
        a, b, c = corner_uvs[face, 0], corner_uvs[face, 1], corner_uvs[face, 2]
        doubled = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        texels = abs(doubled) / 2.0 * n_texels * footprints[point]
        levels[point] = int(np.log2(max(texels, 1.0)) / 2.0)
    return levels


@compiled
def read_nearest(image: ByteArray, uvs: FloatArray, chosen: IntArray, colours: FloatArray) -> None:
    """Write the texels that the chosen points lie in; coordinates repeat, v runs upwards; 0…1."""
    height, width = image.shape[:2]
    for point in chosen:
        column = int((uvs[point, 0] % 1.0) * width) % width
        row = int(((1.0 - uvs[point, 1]) % 1.0) * height) % height
        for channel in range(3):
            colours[point, channel] = image[row, column, channel] / 255.0


@compiled
def read_between(image: ByteArray, uvs: FloatArray, chosen: IntArray, colours: FloatArray) -> None:
    """Write what the image holds at the chosen points, bilinearly, as `read_nearest` otherwise."""
    height, width = image.shape[:2]
    for point in chosen:
        x = (uvs[point, 0] % 1.0) * width - 0.5
        y = ((1.0 - uvs[point, 1]) % 1.0) * height - 0.5
        left, top = int(np.floor(x)), int(np.floor(y))
        across, down = x - left, y - top
        upper, lower = top % height, (top + 1) % height
        first, second = left % width, (left + 1) % width
        for channel in range(3):
            above = image[upper, first, channel] * (1.0 - across) + image[upper, second, channel] * across
            below = image[lower, first, channel] * (1.0 - across) + image[lower, second, channel] * across
            colours[point, channel] = (above * (1.0 - down) + below * down) / 255.0
