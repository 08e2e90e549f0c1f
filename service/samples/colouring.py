"""Coats: a palette, a pattern that marks it, and how parts of the body differ."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from service.samples.noise import cell_distances, layered_noise
from worker.arrays import FloatArray

Pattern = Callable[[FloatArray, np.random.Generator], FloatArray]  # (n, 3) points → (n,) in 0…1


@dataclass(frozen=True, kw_only=True)
class Coat:
    """What a creature wears."""

    name: str  # for the sample's metadata
    pattern: str  # a key of PATTERNS
    scale: float  # size of the pattern's features, in units of the body
    base: str  # main colour, #rrggbb
    mark: str  # colour of the pattern
    belly: str  # colour below
    accent: str  # horns, beaks, crests
    foot: str  # feet and hands
    tip: str  # fins, wing tips, ends of arms
    seed: int = 0  # of the pattern's randomness


def step(values: FloatArray, edge: float, width: float) -> FloatArray:
    """Return 0 below ``edge``, 1 above, smooth over ``width``."""
    share = np.clip((values - edge) / width + 0.5, 0.0, 1.0)
    result: FloatArray = share * share * (3 - 2 * share)
    return result


def stripes(points: FloatArray, generator: np.random.Generator) -> FloatArray:
    """Mark bands across the body's length, wavering."""
    waver = 0.45 * layered_noise(points * 0.7, generator, 2)
    return step(np.sin(2 * np.pi * (points[:, 2] + 0.35 * points[:, 1] + waver)), 0.15, 0.5)


def rings(points: FloatArray, generator: np.random.Generator) -> FloatArray:
    """Mark bands at equal distance from the body's axis, for what has arms all around."""
    waver = 0.1 * layered_noise(points, generator, 2)
    return step(np.sin(2 * np.pi * (np.linalg.norm(points[:, [0, 2]], axis=1) + waver)), 0.1, 0.5)


def spots(points: FloatArray, generator: np.random.Generator) -> FloatArray:
    """Mark round dots."""
    return 1 - step(cell_distances(points, generator)[:, 0], 0.36, 0.14)


def patches(points: FloatArray, generator: np.random.Generator) -> FloatArray:
    """Mark polygons with light seams, as on a giraffe."""
    near, second = cell_distances(points, generator).T
    return step(second - near, 0.16, 0.12)


def clouds(points: FloatArray, generator: np.random.Generator) -> FloatArray:
    """Mark large soft blots, as on a cow."""
    return step(layered_noise(points * 0.8, generator, 2), 0.08, 0.16)


def marble(points: FloatArray, generator: np.random.Generator) -> FloatArray:
    """Mark thin veins."""
    return 1 - step(np.abs(layered_noise(points * 0.6, generator, 3)), 0.07, 0.12)


def dusk(points: FloatArray, generator: np.random.Generator) -> FloatArray:
    """Change slowly from one colour to the other, on a slant."""
    waver = 0.5 * layered_noise(points, generator, 2)
    return step(np.sin(2.2 * (points[:, 1] + 0.4 * points[:, 2]) + waver), 0.0, 1.6)


def speckles(points: FloatArray, generator: np.random.Generator) -> FloatArray:
    """Mark fine irregular grain."""
    return step(layered_noise(points * 2.2, generator, 2), 0.12, 0.3)


PATTERNS: Mapping[str, Pattern] = {
    "stripes": stripes,
    "rings": rings,
    "spots": spots,
    "patches": patches,
    "clouds": clouds,
    "marble": marble,
    "dusk": dusk,
    "speckles": speckles,
}


def rgb(colour: str) -> FloatArray:
    """Return ``#rrggbb`` as sRGB in 0…1, (3,)."""
    return np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)]) / 255


def mix(first: FloatArray, second: FloatArray, share: FloatArray) -> FloatArray:
    """Return colours (n, 3) between two, ``share`` (n,) of the second."""
    return first + (second - first) * share[:, None]
