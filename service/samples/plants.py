"""Plants and pebbles: random flesh melted together, without a skeleton."""

from functools import partial

import numpy as np

from service.samples.builder import BodyBuilder, Point
from service.samples.flesh import Skin
from service.samples.painting import paint
from service.samples.palettes import random_coat
from service.samples.shell import Shell, triangles
from service.samples.surface import polygonise


def plant(generator: np.random.Generator) -> Shell:
    """Grow a stem that forks a few times, with leaves or fruit at its ends."""
    builder = BodyBuilder("plant", (0.0, 0.0, 0.0))
    builder.cone("root", (0, 0, 0), (0, 0.5, 0), (0.12, 0.09), "foot")
    for _ in range(int(generator.integers(3, 9))):
        angle, rise = generator.uniform(0, 2 * np.pi), generator.uniform(0.2, 0.8)
        reach = generator.uniform(0.3, 0.7)
        end: Point = (float(reach * np.cos(angle)), float(0.5 + rise), float(reach * np.sin(angle)))
        builder.cone("root", (0, 0.45, 0), end, (0.07, 0.06))
        builder.ball("root", end, float(generator.uniform(0.1, 0.25)), "tip")
    return _skinned(builder, generator)


def pebbles(generator: np.random.Generator) -> Shell:
    """Make a heap of balls and rods."""
    builder = BodyBuilder("pebbles", (0.0, 0.0, 0.0))
    centre = np.zeros(3)
    for number in range(int(generator.integers(2, 9))):
        start = centre + generator.normal(0, 0.25, 3)
        end = start + generator.normal(0, 0.3, 3)
        radii = generator.uniform(0.1, 0.3, 2)
        part = ("body", "tip", "accent")[number % 3]
        flat: tuple[Point, float] = ((0.0, 1.0, 0.0), float(generator.uniform(1, 2)))
        builder.cone("root", _point(start), _point(end), (float(radii[0]), float(radii[1])), part, flat)
        centre = (start + end) / 2
    return _skinned(builder, generator)


def _point(values: np.ndarray[tuple[int], np.dtype[np.float64]]) -> Point:
    x, y, z = values.tolist()
    return (x, y, z)


def _skinned(builder: BodyBuilder, generator: np.random.Generator) -> Shell:
    skin = Skin(builder.build(0.03))
    lower, upper = skin.bounds
    vertices, quads = polygonise(skin, lower, upper, n_vertices=5000)
    return Shell(
        vertices=vertices,
        rest=vertices,
        faces=triangles(vertices, quads),
        paint=partial(paint, skin, random_coat(generator)),
    )
