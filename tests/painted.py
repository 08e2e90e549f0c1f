"""A creature whose head is painted in this colour or that, and sides of explanations about it."""

from collections.abc import Sequence
from dataclasses import replace
from functools import cache

import numpy as np

from index.methods import METHODS
from index.vocabulary import default_vocabulary
from service.quantisation import quantise
from service.samples.creatures import make_creature
from service.samples.palettes import COATS
from service.samples.writing import ply_bytes
from service.why.sides import Side, side_of
from worker.arrays import BoolArray, FloatArray
from worker.describe import Description, describe
from worker.parameters import Parameters
from worker.reading.upload import Upload

ORANGE, BLUE = (0.9, 0.5, 0.1), (0.1, 0.4, 0.8)
HEAD = 0.75  # of the height: what is above
NAMES = ("log-hks", "colour-histogram", "colour-curves", "hks-0", "hks-0.05", "hks-0.1")


def is_head(points: FloatArray) -> BoolArray:
    """Tell which points (n, 3) of a creature belong to its head."""
    lower, upper = points[:, 1].min(), points[:, 1].max()
    return np.asarray(points[:, 1] > lower + HEAD * (upper - lower))


def with_head(colour: Sequence[float]) -> bytes:
    """Return the PLY of a grey creature, darker below, with a head of a colour of its own."""

    def paint(rest: FloatArray, _: FloatArray) -> FloatArray:
        height = (rest[:, 1] - rest[:, 1].min()) / np.ptp(rest[:, 1])
        grey = np.tile(0.2 + 0.5 * height[:, None], (1, 3))
        return np.where(is_head(rest)[:, None], np.array(colour), grey)

    shell = make_creature("grazer", COATS["savannah"], n_vertices=3000)
    return ply_bytes(replace(shell, paint=paint))


@cache
def described(colour: Sequence[float]) -> Description:
    """Describe it with the usual parameters."""
    return describe(Upload(files={"creature.ply": with_head(colour)}))


@cache
def side(colour: Sequence[float]) -> Side:
    """Return its side of an explanation, in the words of the shipped vocabulary."""
    known = described(colour)
    blocks = {**known.blocks, **quantise(known.signatures, default_vocabulary())}
    return side_of(blocks, known.signatures, known.preview, NAMES, Parameters())


PLACED_METHODS = [name for name, method in METHODS.items() if {b.name for b in method.blocks} <= set(NAMES)]
