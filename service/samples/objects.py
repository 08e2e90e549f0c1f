"""Plain things: vases, knots, furniture, gears, plants; so that a vocabulary sees more than animals."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial

import numpy as np

from service.samples.colouring import PATTERNS, Coat, mix, rgb, step
from service.samples.grids import box, lathe, sheet_faces, tube
from service.samples.palettes import random_coat
from service.samples.shell import Shell
from worker.arrays import FloatArray

Random = np.random.Generator
Box = tuple[Sequence[float], Sequence[float]]  # lower and upper corner


def vase(generator: Random) -> Shell:
    """Make a turned vessel with a wall, closed at the bottom."""
    heights = np.linspace(0, 1, 70)
    waves = sum(
        generator.normal(0, 0.13 / k) * np.sin(np.pi * k * heights + generator.uniform(0, 6))
        for k in (1, 2, 3)
    )
    outer = np.clip(0.3 + waves, 0.1, 0.6)
    wall = np.minimum(0.03, 0.3 * outer)
    outside = np.stack([outer, heights * generator.uniform(0.8, 1.6)], 1)
    inside = (outside - np.stack([wall, np.zeros(70)], 1))[::-1]
    inside[-1] = (0.02, 0.05)
    profile = np.vstack([[[0.001, 0.0]], outside, inside])
    return _swept(lathe(profile[::-1], 56), random_coat(generator), closed=True)


def knot(generator: Random) -> Shell:
    """Make a ring or torus knot with a tube of changing thickness."""
    turns, rounds = [(1, 0), (2, 3), (3, 2), (1, 3), (2, 5)][generator.integers(5)]
    t = 2 * np.pi * np.arange(260) / 260
    out = 1 + 0.4 * np.cos(rounds * t) * (rounds > 0)
    centres = np.stack(
        [out * np.cos(turns * t), 0.4 * np.sin(rounds * t) + 0 * t, out * np.sin(turns * t)], 1
    )
    radii = generator.uniform(0.1, 0.2) * (1 + 0.25 * np.sin(generator.integers(1, 5) * t))
    return _swept(tube(centres, radii, 24), random_coat(generator), closed=True)


def gear(generator: Random) -> Shell:
    """Make a wheel with teeth and a bore."""
    teeth = int(generator.integers(7, 20))
    bore, thickness = generator.uniform(0.15, 0.5), generator.uniform(0.08, 0.3)
    corners = np.array([[bore, thickness], [bore, -thickness], [1, -thickness], [1, thickness]])
    profile = np.vstack(
        [np.linspace(a, b, 12, endpoint=False) for a, b in zip(corners, np.roll(corners, -1, 0), strict=True)]
    )
    points = lathe(profile[::-1], 200)
    angles = 2 * np.pi * np.arange(200) / 200
    tooth = 1 + generator.uniform(0.05, 0.12) * np.tanh(4 * np.sin(teeth * angles))
    reach = np.clip((np.linalg.norm(points[:, :, [0, 2]], axis=2) - 0.8) * 5, 0, 1)
    points[:, :, [0, 2]] *= (1 + (tooth - 1) * reach)[:, :, None]
    return _swept(points, random_coat(generator), closed=True)


def table(generator: Random) -> Shell:
    """Make a plate on four legs, perhaps with a back: a chair."""
    width, depth, height = generator.uniform(0.4, 1.0, 3)
    thick = generator.uniform(0.03, 0.07)
    boxes: list[Box] = [((-width, height, -depth), (width, height + 1.5 * thick, depth))]
    for x in (-width, width - 2 * thick):
        boxes += [((x, 0, z), (x + 2 * thick, height, z + 2 * thick)) for z in (-depth, depth - 2 * thick)]
    if generator.uniform() < 0.5:
        boxes.append(((-width, height, -depth), (width, 2 * height, -depth + 1.5 * thick)))
    return _joined(boxes, generator)


def shelf(generator: Random) -> Shell:
    """Put boards between two sides, with boxes of other colours on them."""
    width, boards = generator.uniform(0.4, 0.9), int(generator.integers(2, 5))
    boxes: list[Box] = [
        ((side, 0, -0.2), (side + 0.05, 0.45 * boards, 0.2)) for side in (-width - 0.05, width)
    ]
    for board in range(boards):
        low = 0.45 * board
        boxes.append(((-width, low, -0.2), (width, low + 0.05, 0.2)))
        place = -width + 0.05
        while place < width - 0.25:
            size = generator.uniform(0.05, 0.2)
            boxes.append(
                ((place, low + 0.06, -0.12), (place + size, low + generator.uniform(0.15, 0.38), 0.12))
            )
            place += size + generator.uniform(0.02, 0.3)
    return _joined(boxes, generator)


THINGS: Mapping[str, Callable[[Random], Shell]] = {
    "vase": vase,
    "knot": knot,
    "gear": gear,
    "table": table,
    "shelf": shelf,
}


def _swept(points: FloatArray, coat: Coat, *, closed: bool) -> Shell:
    rows, columns = points.shape[:2]
    vertices = points.reshape(-1, 3)
    faces = sheet_faces(rows, columns, closed=closed)
    return Shell(vertices=vertices, rest=vertices, faces=faces, paint=partial(_glaze, coat))


def _glaze(coat: Coat, points: FloatArray, normals: FloatArray) -> FloatArray:
    """Colour a thing: the coat's pattern, and its accent on what looks upwards."""
    marks = PATTERNS[coat.pattern](points / coat.scale, np.random.default_rng(coat.seed))
    glazed = mix(np.broadcast_to(rgb(coat.base), points.shape), rgb(coat.mark), marks)
    return mix(glazed, rgb(coat.accent), step(normals[:, 1], 0.9, 0.1))


def _joined(boxes: Sequence[Box], generator: Random) -> Shell:
    sides = [box(np.array(lower, float), np.array(upper, float), 8) for lower, upper in boxes]
    starts = np.cumsum([0] + [len(vertices) for vertices, _ in sides])
    vertices = np.vstack([vertices for vertices, _ in sides])
    faces = np.vstack([faces + start for (_, faces), start in zip(sides, starts, strict=False)])
    coats = [random_coat(generator)] * 5 + [random_coat(generator) for _ in sides[5:]]
    bounds = np.array([(np.array(lower, float), np.array(upper, float)) for lower, upper in boxes])
    return Shell(vertices=vertices, rest=vertices, faces=faces, paint=partial(_boards, coats, bounds))


def _boards(coats: Sequence[Coat], bounds: FloatArray, points: FloatArray, normals: FloatArray) -> FloatArray:
    """Colour each box by its own coat; a point belongs to the box that it lies on or next to."""
    outside = np.maximum(
        bounds[:, 0][None] - points[:, None], points[:, None] - bounds[:, 1][None]
    )  # (n, b, 3)
    owner = np.abs(outside.max(2)).argmin(1)
    colours = np.empty(points.shape)
    for number, coat in enumerate(coats):
        own = owner == number
        colours[own] = _glaze(coat, points[own], normals[own]) if own.any() else 0
    return colours
