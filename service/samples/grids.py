"""Surfaces swept over two parameters: lathes, tubes and boxes."""

import numpy as np

from worker.arrays import FloatArray, IntArray


def sheet_faces(rows: int, columns: int, *, closed: bool) -> IntArray:
    """Return triangles (m, 3) of a grid numbered row by row; ``closed`` joins the last row to the first.

    Columns always go round.
    """
    row, column = np.meshgrid(np.arange(rows if closed else rows - 1), np.arange(columns), indexing="ij")
    low, high = row * columns, (row + 1) % rows * columns
    beside = (column + 1) % columns
    quads = np.stack([low + column, low + beside, high + beside, high + column], -1).reshape(-1, 4)
    return np.vstack([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def lathe(profile: FloatArray, columns: int) -> FloatArray:
    """Turn a profile (r, 2) of radius and height about the y axis: points (r, columns, 3)."""
    angles = -2 * np.pi * np.arange(columns) / columns
    radius, height = profile[:, :1], np.repeat(profile[:, 1:], columns, axis=1)
    return np.stack([radius * np.sin(angles), height, radius * np.cos(angles)], axis=-1)


def tube(centres: FloatArray, radii: FloatArray, columns: int) -> FloatArray:
    """Put a ring around each point (r, 3) of a closed curve: points (r, columns, 3)."""
    ahead = np.roll(centres, -1, axis=0) - np.roll(centres, 1, axis=0)
    ahead /= np.linalg.norm(ahead, axis=1, keepdims=True)
    side = np.cross(ahead, centres - centres.mean(0) + 1e-9)
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    over = np.cross(side, ahead)
    angles = -2 * np.pi * np.arange(columns) / columns
    rings = side[:, None] * np.cos(angles)[:, None] + over[:, None] * np.sin(angles)[:, None]
    result: FloatArray = centres[:, None] + radii[:, None, None] * rings
    return result


def box(lower: FloatArray, upper: FloatArray, pieces: int) -> tuple[FloatArray, IntArray]:
    """Return a box whose sides are grids of ``pieces``² squares: vertices (n, 3) and triangles (m, 3).

    Each side has its own vertices, as in files with sharp edges.
    """
    steps = np.linspace(0, 1, pieces + 1)
    u, v = np.meshgrid(steps, steps, indexing="ij")
    vertices: list[FloatArray] = []
    faces: list[IntArray] = []
    for axis in range(3):
        for end in (0.0, 1.0):
            side = np.stack([np.full(u.shape, end), u, v], -1).reshape(-1, 3)
            squares = _square_faces(pieces) + len(vertices) * (pieces + 1) ** 2
            vertices.append(np.roll(side, axis, axis=1))
            faces.append(squares if end else squares[:, ::-1])
    return lower + np.vstack(vertices) * (upper - lower), np.vstack(faces)


def _square_faces(pieces: int) -> IntArray:
    row, column = np.meshgrid(np.arange(pieces), np.arange(pieces), indexing="ij")
    corner = (row * (pieces + 1) + column).reshape(-1, 1)
    quads = corner + np.array([0, pieces + 1, pieces + 2, 1])
    return np.vstack([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
