"""Containment: a cut part lies on its whole, another shape does not."""

import numpy as np
import pytest

from service.samples.creatures import make_creature
from service.samples.palettes import random_coat
from tests.test_alignment import AREA, VERTICES, WHOLE
from worker.arrays import FloatArray
from worker.descriptors.alignment import Placed
from worker.descriptors.containment import gap
from worker.geometry.resampling import face_areas, resample

DIRECTIONS = ((1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.6, 0.0, 0.8), (-1.0, 1.0, 1.0))


def cut(direction: FloatArray, kept: float) -> tuple[Placed, float]:
    """Return what is left of the whole, scaled to its own canonical area, and the share that it is."""
    vertices, faces = WHOLE
    depths = vertices[faces].mean(axis=1) @ direction
    left = faces[depths <= np.quantile(depths, kept)]
    share = float(face_areas(vertices, left).sum() / AREA)
    used, places = np.unique(left, return_inverse=True)
    part, triangles = resample(vertices[used], places.reshape(-1, 3), AREA, VERTICES)
    return Placed(part, triangles), share


@pytest.mark.parametrize("direction", DIRECTIONS)
@pytest.mark.parametrize("kept", [0.5, 0.75, 0.9])
def test_a_part_lies_on_its_whole(direction: tuple[float, float, float], kept: float) -> None:
    part, share = cut(np.array(direction), kept)
    assert gap(part, Placed(*WHOLE), share**0.5) < 1.3


def test_a_part_of_another_size_does_not() -> None:
    part, share = cut(np.array(DIRECTIONS[0]), 0.7)
    assert gap(part, Placed(*WHOLE), 1.4 * share**0.5) > 2.0


def test_another_animal_does_not() -> None:
    shell = make_creature("bird", random_coat(np.random.default_rng(1)), n_vertices=4000)
    bird = Placed(*resample(shell.vertices, shell.faces, AREA, VERTICES))
    assert gap(bird, Placed(*WHOLE), 0.8) > 3.0


def test_a_part_may_come_from_anywhere() -> None:
    part, share = cut(np.array(DIRECTIONS[1]), 0.8)
    shifted = Placed(part.vertices + [500.0, -200.0, 70.0], part.faces)
    assert gap(shifted, Placed(*WHOLE), share**0.5) == pytest.approx(
        gap(part, Placed(*WHOLE), share**0.5), abs=0.05
    )
