"""A library with real descriptions in small: every stage runs, each on little."""

import functools

import numpy as np

from index.vocabulary import Vocabulary, learn_vocabulary
from service.jobs.rehearsal import SMALL
from service.library import Library
from service.settings import Settings
from worker.describe import describe
from worker.reading.upload import Upload

TAUGHT_BY = 12  # meshes; together they have more signatures than a vocabulary has words
SIDES = ("4 0 2 3 1", "4 4 5 7 6", "4 0 1 5 4", "4 2 6 7 3", "4 0 4 6 2", "4 1 3 7 5")  # of a block


def open_small_library(settings: Settings) -> Library:
    """Open a library whose parameters make a description cost hundredths of a second."""
    return Library.open(settings, parameters=SMALL, vocabulary=small_vocabulary())


@functools.cache
def small_vocabulary() -> Vocabulary:
    """Learn a vocabulary for the small parameters."""
    shapes = [good_mesh(number) for number in range(TAUGHT_BY)]
    signatures = [describe(Upload(files=files), SMALL).signatures for files in shapes]
    return learn_vocabulary(signatures, SMALL.fingerprint())


def good_mesh(number: int) -> dict[str, bytes]:
    """Return a coloured block that nothing is wrong with; other numbers give other blocks."""
    random = np.random.default_rng(number)
    height, width = random.uniform(0.5, 3, 2)
    corners = [(x * width, y, z * height) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    colours = random.integers(0, 256, (8, 3))
    header = ["ply", "format ascii 1.0", "element vertex 8", *(f"property float {axis}" for axis in "xyz")]
    header += [f"property uchar {name}" for name in ("red", "green", "blue")]
    header += ["element face 6", "property list uchar int vertex_indices", "end_header"]
    lines = [f"{x} {y} {z} {r} {g} {b}" for (x, y, z), (r, g, b) in zip(corners, colours, strict=True)]
    return {"good.ply": "\n".join([*header, *lines, *SIDES, ""]).encode()}
