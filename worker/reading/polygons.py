"""Polygons become triangles: fans where that is right, ear clipping where it is not."""

import mapbox_earcut
import numpy as np

from worker.arrays import FloatArray, IntArray
from worker.errors import Code, MeshError

LONGEST = 20_000  # corners of one polygon; ear clipping of more could take minutes


def triangulate(vertices: FloatArray, corners: IntArray, counts: IntArray) -> tuple[IntArray, IntArray]:
    """Split polygons into triangles, keeping their order and direction.

    Parameters
    ----------
    vertices : FloatArray
        (n, 3)
    corners : IntArray
        (k,) vertex indices, polygon after polygon.
    counts : IntArray
        (f,) corners of each polygon, at least 3; they sum to k.

    Returns
    -------
    triangles : IntArray
        (m, 3) positions in `corners`.
    sources : IntArray
        (m,) the polygon of each triangle, ascending.

    Raises
    ------
    MeshError
        TOO_COMPLEX where one polygon has more than `LONGEST` corners.
    """
    if counts.size and counts.max() > LONGEST:
        raise MeshError(
            Code.TOO_COMPLEX, f"One face has {int(counts.max())} corners; at most {LONGEST} are read."
        )
    if (counts == 3).all():
        return np.arange(3 * len(counts)).reshape(-1, 3), np.arange(len(counts))
    offsets = np.cumsum(counts) - counts  # (f,)
    triangles, sources = [], []
    for size in np.unique(counts):
        polygons = np.flatnonzero(counts == size)
        positions = offsets[polygons, None] + np.arange(size)  # (p, size)
        split, owners = _split(vertices[corners[positions]])
        triangles.append(offsets[polygons[owners], None] + split)
        sources.append(polygons[owners])
    return _in_file_order(triangles, sources)


def _in_file_order(triangles: list[IntArray], sources: list[IntArray]) -> tuple[IntArray, IntArray]:
    if not triangles:
        return np.zeros((0, 3), dtype=np.int64), np.zeros(0, dtype=np.int64)
    owners = np.concatenate(sources)
    order = np.argsort(owners, kind="stable")
    return np.concatenate(triangles)[order], owners[order]


def _split(points: FloatArray) -> tuple[IntArray, IntArray]:
    """Split p polygons of one size: points (p, size, 3) → triangles of 0…size-1 (m, 3), owners (m,)."""
    n_polygons, size = points.shape[:2]
    if size == 3:
        return np.tile(np.arange(3), (n_polygons, 1)), np.arange(n_polygons)
    points = points - points.mean(axis=1, keepdims=True)
    normals = newell_normals(points)  # (p, 3)
    fans = np.stack([_fan(size, start) for start in (0, 1)])  # (2, size-2, 3)
    worst = np.stack([_smallest(points, normals, fan) for fan in fans])  # (2, p)
    split = fans[np.argmax(worst, axis=0)]  # (p, size-2, 3)
    # Flat triangles are no reason to clip ears, and of a quad one of the two fans is always the best.
    ears = (worst.max(axis=0) < -1e-12 * (normals**2).sum(axis=1)) & (size > 4)
    owners = np.repeat(np.arange(n_polygons), size - 2)
    kept = ~np.repeat(ears, size - 2)
    clipped = [_clip(points[polygon], normals[polygon]) for polygon in np.flatnonzero(ears)]
    lengths = [len(triangles) for triangles in clipped]
    return (
        np.concatenate([split.reshape(-1, 3)[kept], *clipped]),
        np.concatenate([owners[kept], np.repeat(np.flatnonzero(ears), lengths)]),
    )


def _fan(size: int, start: int) -> IntArray:
    """Return the fan of a polygon's corners around the corner `start`: (size-2, 3)."""
    steps = np.arange(1, size - 1)
    return (np.stack([np.zeros_like(steps), steps, steps + 1], axis=1) + start) % size


def newell_normals(points: FloatArray) -> FloatArray:
    """Return twice the vector areas of closed polygons, planar or not (Newell's method).

    Parameters
    ----------
    points : FloatArray
        (p, size, 3)

    Returns
    -------
    FloatArray
        (p, 3)
    """
    normals: FloatArray = np.cross(points, np.roll(points, -1, axis=1)).sum(axis=1)
    return normals


def _smallest(points: FloatArray, normals: FloatArray, fan: IntArray) -> FloatArray:
    """Return the smallest signed triangle of the fan in each polygon, seen along its normal: (p,)."""
    a, b, c = (points[:, fan[:, corner]] for corner in range(3))  # (p, size-2, 3)
    signed: FloatArray = np.einsum("pti,pi->pt", np.cross(b - a, c - a), normals)  # (p, size-2)
    smallest: FloatArray = signed.min(axis=1)
    return smallest


def _clip(points: FloatArray, normal: FloatArray) -> IntArray:
    """Clip the ears of one polygon in the plane that shows most of it: (size, 3) → (m, 3)."""
    dropped = int(np.argmax(np.abs(normal)))
    plane = np.delete(points, dropped, axis=1)  # (size, 2)
    size = len(points)
    found = mapbox_earcut.triangulate_float64(np.ascontiguousarray(plane), np.array([size], dtype=np.uint32))
    triangles = found.astype(np.int64).reshape(-1, 3)
    a, b, c = (plane[triangles[:, corner]] for corner in range(3))
    area = np.sum((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
    turned = normal[dropped] * (-1.0 if dropped == 1 else 1.0)  # dropping y mirrors the plane
    return triangles[:, ::-1] if area * turned < 0 else triangles
