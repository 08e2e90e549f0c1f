"""As many different coloured shapes as asked for: what a default vocabulary is learnt from."""

from collections.abc import Iterator

import numpy as np

from service.samples.creatures import KINDS, make_creature, random_pose
from service.samples.objects import THINGS
from service.samples.palettes import random_coat
from service.samples.pictures import picture_box
from service.samples.plants import pebbles, plant
from service.samples.proportions import random_proportions
from service.samples.sample import Sample
from service.samples.writing import ply_bytes

GROWN = {"plant": plant, "pebbles": pebbles}


def random_creatures(count: int, seed: int) -> Iterator[Sample]:
    """Make shapes of varied proportions, poses and coats; the same for the same seed.

    See `random_creature`.
    """
    for number in range(count):
        yield random_creature(number, seed)


def random_creature(number: int, seed: int) -> Sample:
    """Make one of those shapes by itself.

    Of each eight, five are creatures, two are things or plants, and one is a box with pictures or a thing.
    """
    generator = np.random.default_rng((seed, number))
    place = number % 8
    if place < 5:
        return _creature(number, generator)
    if place < 7 or number % 16 == 7:
        return _thing(number, generator)
    return picture_box(f"{number:04d} box", generator)


def _creature(number: int, generator: np.random.Generator) -> Sample:
    kind = sorted(KINDS)[number % len(KINDS)]
    coat = random_coat(generator)
    shell = make_creature(
        kind,
        coat,
        random_pose(kind, generator),
        proportions=random_proportions(generator),
        n_vertices=int(generator.integers(4000, 8000)),
        offset=float(generator.uniform()),
    )
    metadata = {"kind": kind, "pose": "random", "coat": coat.pattern}
    return Sample(name=f"{number:04d} {kind}", files={f"{kind}.ply": ply_bytes(shell)}, metadata=metadata)


def _thing(number: int, generator: np.random.Generator) -> Sample:
    makers = {**THINGS, **GROWN}
    kind = sorted(makers)[int(generator.integers(len(makers)))]
    shell = makers[kind](generator)
    metadata = {"kind": kind, "pose": "still", "coat": "random"}
    return Sample(name=f"{number:04d} {kind}", files={f"{kind}.ply": ply_bytes(shell)}, metadata=metadata)
