"""Solid textures: numbers spread over space, the same for the same seed on every machine."""

import numpy as np
from scipy.spatial import KDTree

from worker.arrays import FloatArray

TABLE = 256  # random values that the lattice is filled with, repeating


def smooth_noise(points: FloatArray, generator: np.random.Generator) -> FloatArray:
    """Return value noise in −1…1, (n,), that varies over one unit."""
    values = generator.uniform(-1, 1, (TABLE,))
    order = generator.permutation(TABLE)
    cells = np.floor(points).astype(int)
    share = points - cells
    share = share * share * (3 - 2 * share)
    total = np.zeros(len(points))
    for corner in np.ndindex(2, 2, 2):
        x, y, z = ((cells + corner) % TABLE).T
        weight = np.prod(np.where(corner, share, 1 - share), axis=1)
        total += weight * values[order[(order[(order[x] + y) % TABLE] + z) % TABLE]]
    return total


def layered_noise(points: FloatArray, generator: np.random.Generator, layers: int = 3) -> FloatArray:
    """Return a sum of noises at doubling frequencies and halving heights, (n,), about −1…1."""
    total = np.zeros(len(points))
    for layer in range(layers):
        total += smooth_noise(points * 2**layer, generator) / 2**layer
    return total / 1.4


def cell_distances(points: FloatArray, generator: np.random.Generator) -> FloatArray:
    """Return distances (n, 2) to the nearest and second nearest of scattered seeds, about one per unit cube.

    The cells are those of S. Worley, *A cellular texture basis function* (1996), on a repeating block.
    """
    size = 8
    seeds = np.stack(np.meshgrid(*[np.arange(size)] * 3, indexing="ij"), -1).reshape(-1, 3)
    scattered = seeds + generator.uniform(0.1, 0.9, (len(seeds), 3))
    tree = KDTree(scattered % size, boxsize=np.full(3, float(size)))
    return np.asarray(tree.query(points % size, k=2)[0])
