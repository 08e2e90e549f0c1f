"""Quadrics: the squared distance to the planes around a vertex, as a function of its place.

Garland and Heckbert (1997), "Surface Simplification Using Quadric Error Metrics".
"""

import numpy as np

from worker.arrays import BoolArray, FloatArray, IntArray
from worker.compiled import compiled


def plane_quadrics(vertices: FloatArray, faces: IntArray, open_sides: BoolArray) -> FloatArray:
    """Sum at each vertex the squared distances to the planes of its faces and through its open edges.

    Parameters
    ----------
    vertices : (n, 3) array
    faces : (m, 3) array
    open_sides : (m, 3) array
        Whether the edge from corner k to corner k + 1 belongs to no other face.

    Returns
    -------
    (n, 9) array
        The normal equations M x = r of the least sum: entries 11, 12, 13, 22, 23, 33 of M and the three of r.
        A face weighs its area, an open edge its length squared.
    """
    quadrics = np.zeros((len(vertices), 9))
    _add_planes(vertices, faces, open_sides, quadrics)
    return quadrics


@compiled
def _add_planes(vertices: FloatArray, faces: IntArray, open_sides: BoolArray, quadrics: FloatArray) -> None:
    normal, across = np.empty(3), np.empty(3)
    for face in range(len(faces)):
        a, b, c = vertices[faces[face, 0]], vertices[faces[face, 1]], vertices[faces[face, 2]]
        doubled = _cross(b - a, c - a, normal)
        if doubled == 0.0:
            continue
        for corner in range(3):
            _add(quadrics[faces[face, corner]], normal, a, doubled / 2.0)
        for corner in range(3):
            if open_sides[face, corner]:
                start, end = faces[face, corner], faces[face, (corner + 1) % 3]
                length = _cross(vertices[end] - vertices[start], normal, across)
                _add(quadrics[start], across, vertices[start], length * length)
                _add(quadrics[end], across, vertices[start], length * length)


@compiled
def _cross(first: FloatArray, second: FloatArray, unit: FloatArray) -> float:
    """Write the direction of a cross product to ``unit``; return its length."""
    x = first[1] * second[2] - first[2] * second[1]
    y = first[2] * second[0] - first[0] * second[2]
    z = first[0] * second[1] - first[1] * second[0]
    length = float(np.sqrt(x * x + y * y + z * z))
    scale = 1.0 / length if length > 0.0 else 0.0
    unit[0], unit[1], unit[2] = x * scale, y * scale, z * scale
    return length


@compiled
def _add(quadric: FloatArray, normal: FloatArray, point: FloatArray, weight: float) -> None:
    x, y, z = normal[0], normal[1], normal[2]
    offset = x * point[0] + y * point[1] + z * point[2]  # n·x = offset on the plane
    quadric[0] += weight * x * x
    quadric[1] += weight * x * y
    quadric[2] += weight * x * z
    quadric[3] += weight * y * y
    quadric[4] += weight * y * z
    quadric[5] += weight * z * z
    quadric[6] += weight * offset * x
    quadric[7] += weight * offset * y
    quadric[8] += weight * offset * z
