"""A surface with a memory: where each point was at rest, so that colours stick when it bends."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from worker.arrays import FloatArray, IntArray

Paint = Callable[
    [FloatArray, FloatArray], FloatArray
]  # rest points (n, 3), rest normals (n, 3) → sRGB (n, 3)


@dataclass(frozen=True, kw_only=True, eq=False)
class Shell:
    """Triangles that can be painted."""

    vertices: FloatArray  # (n, 3), as they go into the file
    rest: FloatArray  # (n, 3), the same points before bending
    faces: IntArray  # (m, 3), counter-clockwise seen from outside
    paint: Paint  # the colour at any rest point


def triangles(vertices: FloatArray, quads: IntArray) -> IntArray:
    """Cut each quad (m, 4) along its shorter diagonal: (2 m, 3)."""
    corners = vertices[quads]  # (m, 4, 3)
    first = np.linalg.norm(corners[:, 0] - corners[:, 2], axis=1)
    second = np.linalg.norm(corners[:, 1] - corners[:, 3], axis=1)
    turned = np.where((first <= second)[:, None], quads, np.roll(quads, -1, axis=1))
    return np.vstack([turned[:, [0, 1, 2]], turned[:, [0, 2, 3]]])


def vertex_normals(vertices: FloatArray, faces: IntArray) -> FloatArray:
    """Return unit normals (n, 3): the mean of the triangles around, weighted by area."""
    corners = vertices[faces]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])  # (m, 3)
    sums = [np.bincount(faces.ravel(), across[:, k].repeat(3), len(vertices)) for k in range(3)]
    normals = np.stack(sums, 1)
    result: FloatArray = normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
    return result
