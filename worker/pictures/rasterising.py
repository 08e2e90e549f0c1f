"""Which triangle is seen at each pixel: a z-buffer, vectorised over pairs of triangle and pixel."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from worker.arrays import FloatArray, IntArray

CHUNK = 50_000  # pairs of triangle and pixel at a time: few enough for a processor's cache


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
    shares = np.zeros((size * size, 3))
    frames = _frames(pixels, faces)
    depths_of = [depths[column] for column in faces.T]
    for numbers, columns, rows in _pairs(pixels, faces, size):
        inside, weights = _barycentrics(frames, numbers, columns, rows)
        numbers, places = numbers[inside], (rows * size + columns)[inside]
        first, second, third = (of[numbers] * weight for of, weight in zip(depths_of, weights, strict=True))
        depth = first + second + third
        np.minimum.at(nearest, places, depth)
        seen = np.flatnonzero(depth == nearest[places])
        owner[places[seen]] = numbers[seen]
        for column, weight in enumerate(weights):
            shares[places[seen], column] = weight[seen]
    covered = np.flatnonzero(owner >= 0)
    return Fragments(places=covered, faces=owner[covered], barycentrics=shares[covered])


def covered_pixels(pixels: FloatArray, faces: IntArray, size: int) -> int:
    """Return how many pairs of triangle and pixel `rasterise` has to look at."""
    return int(_boxes(pixels, faces, size)[2].prod(axis=1).sum())


def _boxes(pixels: FloatArray, faces: IntArray, size: int) -> tuple[IntArray, IntArray, IntArray]:
    """Return the first and last pixel and the number of pixels (m, 2), whose centres a bounding box holds."""
    a, b, c = (pixels[column] for column in faces.T)  # each (m, 2)
    lower, upper = np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)
    first = np.clip(np.ceil(lower - 0.5), 0, size).astype(np.int64)
    last = np.clip(np.floor(upper - 0.5), -1, size - 1).astype(np.int64)
    return first, last, np.maximum(last - first + 1, 0)


def _pairs(pixels: FloatArray, faces: IntArray, size: int) -> Iterator[tuple[IntArray, IntArray, IntArray]]:
    """Yield triangles, columns and rows: the pixels of bounding boxes, at most about a chunk at once."""
    first, _, counts = _boxes(pixels, faces, size)
    ends = np.cumsum(counts.prod(axis=1))
    start = 0
    while start < len(ends):
        done = ends[start - 1] if start else 0
        stop = max(int(np.searchsorted(ends, done + CHUNK)), start + 1)
        boxes, lines = _steps(counts[start:stop, 1])  # each box is cut into lines of pixels
        boxes += start
        of_pixels, steps = _steps(counts[boxes, 0])
        numbers = boxes[of_pixels]
        yield numbers, first[numbers, 0] + steps, (first[boxes, 1] + lines)[of_pixels]
        start = stop


def _steps(counts: IntArray) -> tuple[IntArray, IntArray]:
    """Count from 0 for each entry; return the entry and the count, (sum of counts,) each."""
    owners = np.repeat(np.arange(len(counts)), counts)
    starts = np.cumsum(counts) - counts
    return owners, np.arange(len(owners)) - starts[owners]


def _frames(pixels: FloatArray, faces: IntArray) -> list[FloatArray]:
    """Return what barycentric coordinates need: first corner, the sides from it, area; (m,) each."""
    a, b, c = (pixels[column] for column in faces.T)  # each (m, 2)
    (second_x, second_y), (third_x, third_y) = (b - a).T, (c - a).T
    area = second_x * third_y - second_y * third_x  # twice that, signed
    area[np.abs(area) < 1e-12] = np.nan  # no point is inside
    columns = (a[:, 0], a[:, 1], second_x, second_y, third_x, third_y, area)
    return [np.ascontiguousarray(column) for column in columns]


def _barycentrics(
    frames: list[FloatArray], numbers: IntArray, columns: IntArray, rows: IntArray
) -> tuple[IntArray, list[FloatArray]]:
    """Return which pixels (p,) have their middle inside their triangle, and its barycentrics there."""
    left, top, second_x, second_y, third_x, third_y, area = (column.take(numbers) for column in frames)
    x, y = columns + 0.5 - left, rows + 0.5 - top
    to_second = (x * third_y - y * third_x) / area
    to_third = (second_x * y - second_y * x) / area
    to_first = 1.0 - to_second - to_third
    inside = np.flatnonzero((to_first >= 0) & (to_second >= 0) & (to_third >= 0))
    return inside, [weight.take(inside) for weight in (to_first, to_second, to_third)]
