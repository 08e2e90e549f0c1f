"""Colours of a creature's skin at any point of it, in the rest pose."""

import numpy as np

from service.samples.colouring import PATTERNS, Coat, mix, rgb, step
from service.samples.flesh import Skin
from service.samples.noise import layered_noise
from worker.arrays import FloatArray

GAZE = np.array([0.62, 0.12, 0.78])  # where a left eye looks
EDGE = 0.012  # width over which the colours of neighbouring parts mix


def paint(skin: Skin, coat: Coat, points: FloatArray, normals: FloatArray) -> FloatArray:
    """Return sRGB colours (n, 3) in 0…1.

    Parameters
    ----------
    points : (n, 3)
        On the skin, in the rest pose.
    normals : (n, 3)
        Unit, outwards, in the rest pose.
    """
    distances = skin.distances(points)
    colours = _fur(coat, points, normals)
    for part, colour in _parts(coat).items():
        colours = mix(colours, rgb(colour), _share(skin, distances, part))
    return _eyes(skin, colours, points, distances)


def _fur(coat: Coat, points: FloatArray, normals: FloatArray) -> FloatArray:
    generator = np.random.default_rng(coat.seed)
    marks = PATTERNS[coat.pattern](points / coat.scale, generator)
    grain = 1 + 0.05 * layered_noise(points * 14, generator, 2)
    fur = mix(np.broadcast_to(rgb(coat.base), points.shape), rgb(coat.mark), marks) * grain[:, None]
    shaded: FloatArray = np.clip(mix(fur, rgb(coat.belly), 0.9 * step(-normals[:, 1], 0.62, 0.5)), 0, 1)
    return shaded


def _parts(coat: Coat) -> dict[str, str]:
    return {
        "belly": coat.belly,
        "muzzle": coat.belly,
        "accent": coat.accent,
        "foot": coat.foot,
        "tip": coat.tip,
    }


def _share(skin: Skin, distances: FloatArray, part: str) -> FloatArray:
    chosen = np.array([flesh.part == part for flesh in skin.body.flesh])
    if not chosen.any():
        return np.zeros(len(distances))
    lead = distances[:, ~chosen].min(1) - distances[:, chosen].min(1)
    return step(lead, 0.0, 2 * EDGE)


def _eyes(skin: Skin, colours: FloatArray, points: FloatArray, distances: FloatArray) -> FloatArray:
    nearest = distances.argmin(1)
    for number, flesh in enumerate(skin.body.flesh):
        if flesh.part == "eye":
            own = nearest == number
            outwards = points[own] - flesh.start
            side = np.array([np.sign(flesh.start[0]), 1, 1])
            facing = outwards @ (GAZE * side) / np.maximum(np.linalg.norm(outwards, axis=1), 1e-12)
            ball = np.broadcast_to(rgb("#fbfaf4"), outwards.shape)
            colours[own] = mix(ball, rgb("#16130f"), step(facing, 0.66, 0.12))
    return colours
