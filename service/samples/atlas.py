"""Flat maps of a surface: patches that face the same way, projected and packed into a square."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from service.samples.shell import Shell
from worker.arrays import FloatArray, IntArray

PADDING = 3  # texels between patches
AXES = np.vstack([np.eye(3), -np.eye(3)])  # the six directions that patches face
ACROSS = ((2, 1), (0, 2), (0, 1))  # the coordinates that are kept when one axis is projected away


@dataclass(frozen=True, kw_only=True, eq=False)
class Atlas:
    """Where each corner lies in a picture."""

    texels: FloatArray  # (u, 2), column and row downwards, in texels
    faces: IntArray  # (m, 3), indices of texels, in the order of the shell's faces
    side: int  # width and height of the picture


def unwrap(shell: Shell, side: int) -> Atlas:
    """Cut a shell into patches in the rest pose and pack them into a picture of ``side``² texels."""
    patches, axes = _patches(shell)
    pairs = patches[:, None] * len(shell.rest) + shell.faces  # (m, 3): a vertex once in each patch
    unique, faces = np.unique(pairs, return_inverse=True)
    owner, vertices = unique // len(shell.rest), unique % len(shell.rest)
    flat = np.empty((len(unique), 2))
    for axis in range(3):
        chosen = axes[owner] % 3 == axis
        flat[chosen] = shell.rest[vertices[chosen]][:, ACROSS[axis]]
    return Atlas(texels=_packed(flat, owner, side), faces=faces.reshape(-1, 3), side=side)


def _patches(shell: Shell) -> tuple[IntArray, IntArray]:
    """Return the patch (m,) of each face, and the direction (p,) of each patch."""
    a, b, c = (shell.rest[column] for column in shell.faces.T)
    facing = (np.cross(b - a, c - a) @ AXES.T).argmax(1)  # (m,)
    count = len(facing)
    edges = np.sort(
        np.vstack([shell.faces[:, [0, 1]], shell.faces[:, [1, 2]], shell.faces[:, [2, 0]]]), axis=1
    )
    order = np.lexsort(edges.T)
    same = (edges[order[1:]] == edges[order[:-1]]).all(1)
    first, second = order[:-1][same] % count, order[1:][same] % count
    alike = facing[first] == facing[second]
    links = coo_array((np.ones(alike.sum()), (first[alike], second[alike])), shape=(count, count))
    _, patches = connected_components(links, directed=False)
    axes = np.zeros(patches.max() + 1, dtype=np.int64)
    axes[patches] = facing
    return patches.astype(np.int64), axes


def _packed(flat: FloatArray, owner: IntArray, side: int) -> FloatArray:
    """Scale the patches as large as fits, and lay them on shelves, the tallest first."""
    count = int(owner.max()) + 1
    lower, upper = np.full((count, 2), np.inf), np.full((count, 2), -np.inf)
    np.minimum.at(lower, owner, flat)
    np.maximum.at(upper, owner, flat)
    scale = side / float(np.sqrt((upper - lower).prod(1).sum()))
    corners = _shelves((upper - lower) * scale, side)
    while corners is None:
        scale *= 0.96
        corners = _shelves((upper - lower) * scale, side)
    packed: FloatArray = corners[owner] + (flat - lower[owner]) * scale
    return packed


def _shelves(sizes: FloatArray, side: int) -> FloatArray | None:
    """Return the corner (p, 2) of each rectangle (p, 2), or nothing where they do not fit."""
    corners = np.empty(sizes.shape)
    column = row = float(PADDING)
    height = 0.0
    for patch in np.argsort(-sizes[:, 1], kind="stable"):
        wide, tall = sizes[patch] + PADDING
        if column + wide > side:
            column, row, height = float(PADDING), row + height, 0.0
        if column + wide > side or row + tall > side:
            return None
        corners[patch] = column, row
        column, height = column + wide, max(height, tall)
    return corners
