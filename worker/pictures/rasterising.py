"""Which triangle is seen at each pixel: a z-buffer, vectorised over pairs of triangle and pixel."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from worker.arrays import FloatArray, IntArray

CHUNK = 400_000  # pairs of triangle and pixel at a time; bounds the memory to some 60 MB


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
    for numbers, places in _pairs(pixels, faces, size):
        centres = 0.5 + np.stack([places % size, places // size], axis=1).astype(np.float64)
        weights = _barycentrics(pixels[faces[numbers]], centres)  # (p, 3)
        depth = np.einsum("pc,pc->p", weights, depths[faces[numbers]])
        inside = (weights[:, 0] >= 0) & (weights[:, 1] >= 0) & (weights[:, 2] >= 0)
        seen = inside & (depth <= nearest[places])
        numbers, places, weights, depth = numbers[seen], places[seen], weights[seen], depth[seen]
        np.minimum.at(nearest, places, depth)
        first = depth == nearest[places]
        owner[places[first]], shares[places[first]] = numbers[first], weights[first]
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


def _pairs(pixels: FloatArray, faces: IntArray, size: int) -> Iterator[tuple[IntArray, IntArray]]:
    """Yield triangles and the pixels of their bounding boxes, at most about a chunk of pairs at once."""
    first, _, counts = _boxes(pixels, faces, size)
    totals = counts.prod(axis=1)
    ends = np.cumsum(totals)
    start = 0
    while start < len(totals):
        done = ends[start] - totals[start]
        stop = max(int(np.searchsorted(ends, done + CHUNK)), start + 1)
        numbers = np.repeat(np.arange(start, stop), totals[start:stop])
        steps = np.arange(len(numbers)) + done - (ends - totals)[numbers]
        columns, rows = steps % counts[numbers, 0], steps // counts[numbers, 0]
        yield numbers, (first[numbers, 1] + rows) * size + first[numbers, 0] + columns
        start = stop


def _barycentrics(corners: FloatArray, points: FloatArray) -> FloatArray:
    """Return barycentric coordinates (p, 3) of points (p, 2); negative outside and where there is no area."""
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    away = points - corners[:, 0]
    area = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
    flat = np.abs(area) < 1e-12
    safe = np.where(flat, 1.0, area)
    to_second = (away[:, 0] * second[:, 1] - away[:, 1] * second[:, 0]) / safe
    to_third = (first[:, 0] * away[:, 1] - first[:, 1] * away[:, 0]) / safe
    weights = np.stack([1 - to_second - to_third, to_second, to_third], axis=1)
    weights[flat] = -1.0
    return np.asarray(weights)
