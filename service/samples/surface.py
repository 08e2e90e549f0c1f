"""Closed surfaces from signed fields: naive surface nets on a grid of cubes.

S. Gibson, *Constrained elastic surface nets* (1998), without the elastic part.
"""

from typing import Protocol

import numpy as np

from service.samples.settling import settle
from worker.arrays import BoolArray, FloatArray, IntArray


class Field(Protocol):
    """A closed shape, given by a number at every point."""

    def __call__(self, points: FloatArray) -> FloatArray:
        """Return values (n,) at points (n, 3), negative inside."""

    def near(self, points: FloatArray, radius: float) -> BoolArray:
        """Say for each point (n,) whether the zero level may pass within ``radius`` of it."""


CORNERS = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)])  # (8, 3)
EDGES = np.array([(i, j) for i in range(8) for j in range(i) if np.abs(CORNERS[i] - CORNERS[j]).sum() == 1])
BLOCK = 6  # cubes along a block's side: blocks far from the surface are not evaluated


def surface_nets(values: FloatArray, origin: FloatArray, spacing: float) -> tuple[FloatArray, IntArray]:
    """Polygonise the zero level of a sampled field.

    Parameters
    ----------
    values : (x, y, z)
        The field at grid points, negative inside; positive on the grid's border.
    origin : (3,)
        Position of the first grid point.
    spacing : float
        Distance of neighbouring grid points.

    Returns
    -------
    vertices : (n, 3)
    quads : (m, 4)
        Counter-clockwise seen from outside.
    """
    inside = values < 0
    cubes = np.argwhere(_mixed_cubes(inside))  # (n, 3)
    vertices = origin + spacing * (cubes + _crossing_means(values, cubes))
    numbers = np.full(np.array(inside.shape) - 1, -1)
    numbers[tuple(cubes.T)] = np.arange(len(cubes))
    return vertices, np.vstack([_quads_across(inside, numbers, axis) for axis in range(3)])


def _mixed_cubes(inside: BoolArray) -> BoolArray:
    count = np.zeros(np.array(inside.shape) - 1, dtype=np.int8)
    for x, y, z in CORNERS:
        count += _corner(inside, x, y, z)
    return (count > 0) & (count < 8)


def _corner(inside: BoolArray, x: int, y: int, z: int) -> BoolArray:
    nx, ny, nz = inside.shape
    return inside[x : nx - 1 + x, y : ny - 1 + y, z : nz - 1 + z]


def _crossing_means(values: FloatArray, cubes: IntArray) -> FloatArray:
    at_corners = values[tuple((cubes[:, None] + CORNERS).transpose(2, 0, 1))]  # (n, 8)
    first, second = at_corners[:, EDGES[:, 0]], at_corners[:, EDGES[:, 1]]  # (n, 12)
    crossed = (first < 0) != (second < 0)
    share = np.where(crossed, first / np.where(crossed, first - second, 1.0), 0.0)
    steps = (CORNERS[EDGES[:, 1]] - CORNERS[EDGES[:, 0]])[None] * share[:, :, None]  # (n, 12, 3)
    points = (CORNERS[EDGES[:, 0]][None] + steps) * crossed[:, :, None]
    means: FloatArray = points.sum(1) / crossed.sum(1)[:, None]
    return means


def _quads_across(inside: BoolArray, numbers: IntArray, axis: int) -> IntArray:
    """Return one quad for each grid edge along ``axis`` that crosses the surface."""
    low = np.take(inside, np.arange(inside.shape[axis] - 1), axis)
    high = np.take(inside, np.arange(1, inside.shape[axis]), axis)
    places = np.argwhere(low != high)  # (m, 3), the edge's lower end
    second, third = np.roll(np.eye(3, dtype=int), -1 - axis, axis=0)[:2]
    around = [places, places - second, places - second - third, places - third]
    quads = np.stack([numbers[tuple(cube.T)] for cube in around], axis=1)
    leaving = low[tuple(places.T)]
    return np.where(leaving[:, None], quads, quads[:, ::-1])


def sample_grid(field: Field, origin: FloatArray, shape: IntArray, spacing: float) -> FloatArray:
    """Evaluate a field on a grid, exactly only near its zero level.

    Parameters
    ----------
    origin : (3,)
    shape : (3,)
        Points along each axis, a multiple of the block size.

    Returns
    -------
    values : (x, y, z)
        Away from the surface only the sign is right.
    """
    blocks = np.stack(np.meshgrid(*(np.arange(n // BLOCK) for n in shape), indexing="ij"), -1)
    centres = origin + spacing * (blocks * BLOCK + (BLOCK - 1) / 2)  # (·, ·, ·, 3)
    radius = float(spacing * np.sqrt(3) * (BLOCK + 1) / 2)
    coarse = field(centres.reshape(-1, 3)).reshape(blocks.shape[:3])
    values = coarse.repeat(BLOCK, 0).repeat(BLOCK, 1).repeat(BLOCK, 2)
    near = blocks[field.near(centres.reshape(-1, 3), radius).reshape(blocks.shape[:3])]  # (b, 3)
    steps = np.stack(np.meshgrid(*[np.arange(BLOCK)] * 3, indexing="ij"), -1).reshape(-1, 3)
    places = (near[:, None] * BLOCK + steps).reshape(-1, 3)
    values[tuple(places.T)] = field(origin + spacing * places)
    return values


def polygonise(
    field: Field,
    lower: FloatArray,
    upper: FloatArray,
    *,
    n_vertices: int,
    offset: float = 0.0,
) -> tuple[FloatArray, IntArray]:
    """Make a smooth closed mesh of about ``n_vertices`` from a field.

    Parameters
    ----------
    lower, upper : (3,)
        A box that holds the surface.
    offset : float
        Shifts the grid by this share of a cube, so that one body gets another tessellation.

    Returns
    -------
    vertices : (n, 3)
    quads : (m, 4)
    """
    coarse = float(np.max(upper - lower)) / 28
    found = len(_polygonise_at(field, lower, upper, coarse, 0.0)[0])
    spacing = coarse * np.sqrt(found / n_vertices)
    vertices, quads = _polygonise_at(field, lower, upper, spacing, offset)
    return relax(field, vertices, quads, spacing), quads


def _polygonise_at(
    field: Field, lower: FloatArray, upper: FloatArray, spacing: float, offset: float
) -> tuple[FloatArray, IntArray]:
    origin = lower - (2 + offset) * spacing
    points = np.ceil((upper - origin) / spacing + 3)
    shape = (np.ceil(points / BLOCK) * BLOCK).astype(int)
    return surface_nets(settle(sample_grid(field, origin, shape, spacing)), origin, spacing)


def relax(field: Field, vertices: FloatArray, quads: IntArray, spacing: float) -> FloatArray:
    """Even out the vertices of a net and put them back onto the zero level.

    Two rounds of: each vertex to the mean of its neighbours, then a Newton step along the gradient.
    """
    ends = np.vstack([quads[:, [0, 1]], quads[:, [1, 2]], quads[:, [2, 3]], quads[:, [3, 0]]])
    degree = np.bincount(ends[:, 0], minlength=len(vertices))
    for _ in range(2):
        sums = [np.bincount(ends[:, 0], vertices[ends[:, 1], k], len(vertices)) for k in range(3)]
        vertices = onto_surface(field, np.stack(sums, 1) / degree[:, None], spacing)
    return vertices


def onto_surface(field: Field, points: FloatArray, spacing: float) -> FloatArray:
    """Move points to the zero level by one Newton step, at most one ``spacing`` far."""
    values, slopes = _values_and_slopes(field, points, spacing / 50)
    lengths = np.maximum((slopes**2).sum(1), 1e-12)
    moves = slopes * (values / lengths)[:, None]  # (n, 3)
    far = np.linalg.norm(moves, axis=1, keepdims=True)
    moved: FloatArray = points - moves * np.minimum(1.0, spacing / np.maximum(far, 1e-12))
    return moved


def _values_and_slopes(field: Field, points: FloatArray, step: float) -> tuple[FloatArray, FloatArray]:
    """Return the field (n,) and its forward differences (n, 3)."""
    values = field(points)
    slopes = [field(points + shift) - values for shift in step * np.eye(3)]
    return values, np.stack(slopes, axis=1) / step
