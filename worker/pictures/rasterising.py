"""Which triangle is seen at each pixel: a z-buffer."""

from dataclasses import dataclass

import numpy as np

from worker.arrays import FloatArray, IntArray
from worker.compiled import compiled

FLAT = 1e-12  # squared pixels: a triangle of half that area is seen from its edge


@dataclass(frozen=True, kw_only=True, eq=False)
class Fragments:
    """What is seen: one entry for each pixel that a triangle covers."""

    places: IntArray  # (k,), row · width + column, ascending
    faces: IntArray  # (k,), the triangle in front
    barycentrics: FloatArray  # (k, 3), of the pixel's centre in it


def rasterise(pixels: FloatArray, depths: FloatArray, faces: IntArray, size: int) -> Fragments:
    """Find the nearest triangle at each pixel's centre, seen from either side.

    Parameters
    ----------
    pixels : (n, 2) array
        Vertices: column and row, in pixels.
    depths : (n,) array
        Of the vertices; the nearest is the least.
    faces : (m, 3) array
    size : int
        Width and height of the picture.

    Returns
    -------
    Fragments
        Where two triangles are equally near, the later one.
    """
    nearest = np.full(size * size, np.inf)
    owner = np.full(size * size, -1)
    shares = np.empty((size * size, 3))
    first, last = _boxes(pixels, faces, size)
    _draw(pixels, depths, faces, first, last, size, nearest, owner, shares)
    covered = np.flatnonzero(owner >= 0)
    return Fragments(places=covered, faces=owner[covered], barycentrics=shares[covered])


@compiled
def _draw(
    pixels: FloatArray,
    depths: FloatArray,
    faces: IntArray,
    first: IntArray,
    last: IntArray,
    size: int,
    nearest: FloatArray,
    owner: IntArray,
    shares: FloatArray,
) -> None:
    """Draw triangle after triangle into the z-buffer; first and last (m, 2) are corners of their boxes."""
    for face in range(len(faces)):
        a, b, c = faces[face]
        left, top = pixels[a, 0], pixels[a, 1]
        second_x, second_y = pixels[b, 0] - left, pixels[b, 1] - top
        third_x, third_y = pixels[c, 0] - left, pixels[c, 1] - top
        area = second_x * third_y - second_y * third_x  # twice that, signed
        if abs(area) < FLAT:
            continue  # no point is inside
        for row in range(first[face, 1], last[face, 1] + 1):
            for column in range(first[face, 0], last[face, 0] + 1):
                x, y = column + 0.5 - left, row + 0.5 - top
                to_second = (x * third_y - y * third_x) / area
                to_third = (second_x * y - second_y * x) / area
                to_first = 1.0 - to_second - to_third
                if to_first < 0.0 or to_second < 0.0 or to_third < 0.0:
                    continue
                depth = to_first * depths[a] + to_second * depths[b] + to_third * depths[c]
                place = row * size + column
                if depth <= nearest[place]:
                    nearest[place], owner[place] = depth, face
                    shares[place, 0], shares[place, 1], shares[place, 2] = to_first, to_second, to_third


@compiled
def doubled_areas(pixels: FloatArray, faces: IntArray, chosen: IntArray) -> FloatArray:
    """Return twice the areas of the chosen triangles as they are seen, in squared pixels; (k,)."""
    areas = np.empty(len(chosen))
    for place, face in enumerate(chosen):
        a, b, c = pixels[faces[face, 0]], pixels[faces[face, 1]], pixels[faces[face, 2]]
        areas[place] = abs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
    return areas


def covered_pixels(pixels: FloatArray, faces: IntArray, size: int) -> int:
    """Return how many pairs of triangle and pixel `rasterise` has to look at."""
    first, last = _boxes(pixels, faces, size)
    return int(np.maximum(last - first + 1, 0).prod(axis=1).sum())


@compiled
def _boxes(pixels: FloatArray, faces: IntArray, size: int) -> tuple[IntArray, IntArray]:
    """Return the first and last pixel (m, 2) whose centres lie in each triangle's bounding box."""
    first = np.empty((len(faces), 2), dtype=np.int64)
    last = np.empty((len(faces), 2), dtype=np.int64)
    for face in range(len(faces)):
        for axis in range(2):
            a, b, c = pixels[faces[face, 0], axis], pixels[faces[face, 1], axis], pixels[faces[face, 2], axis]
            lower, upper = min(a, b, c) - 0.5, max(a, b, c) - 0.5
            first[face, axis] = int(min(max(np.ceil(lower), 0.0), size))
            last[face, axis] = int(min(max(np.floor(upper), -1.0), size - 1.0))
    return first, last
