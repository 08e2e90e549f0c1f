"""An image with the statistics of a photograph, made in code."""

import numpy as np

from worker.arrays import ByteArray


def photograph(size: int = 384, seed: int = 0) -> ByteArray:
    """Paint dead leaves (Lee, Mumford and Huang 2001): discs of all sizes hide one another; some grain."""
    random = np.random.default_rng(seed)
    y, x = np.mgrid[:size, :size]
    image = np.full((size, size, 3), 0.5)
    for _ in range(1_500):
        radius = size * 0.3 * (random.uniform(0.004, 1) ** 1.5 + 0.01)
        inside = (x - random.uniform(0, size)) ** 2 + (y - random.uniform(0, size)) ** 2 < radius**2
        image[inside] = random.uniform(0.05, 0.95, 3) * random.uniform(0.4, 1)
    image += random.normal(0, 0.02, image.shape)
    return np.asarray(np.clip(image, 0, 1) * 255, dtype=np.uint8)
