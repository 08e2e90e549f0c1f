"""Alignment: what was turned and shifted fits again, what was bent or mirrored does not."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from service.samples.creatures import make_creature
from service.samples.palettes import random_coat
from tests.shapes import sheet, sphere
from worker.arrays import FloatArray, IntArray
from worker.descriptors.alignment import FITS, Placed, misfit
from worker.geometry.resampling import resample

AREA, VERTICES = 19_000.0, 2_500  # square units


def creature(turn: float = 0.0, offset: float = 0.0) -> tuple[FloatArray, IntArray]:
    """Return a grazer, its neck turned aside by some degrees, meshed anew from some offset."""
    coat = random_coat(np.random.default_rng(1))
    pose = {"neck-0": (0.0, turn, 0.0), "neck-1": (0.0, turn, 0.0)}
    shell = make_creature("grazer", coat, pose, n_vertices=4000, offset=offset)
    return resample(shell.vertices, shell.faces, AREA, VERTICES)


WHOLE = creature()


def moved(vertices: FloatArray, seed: int) -> FloatArray:
    random = np.random.default_rng(seed)
    return vertices @ Rotation.random(rng=random).as_matrix().T + random.normal(0.0, 100.0, 3)


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_a_turned_and_shifted_copy_in_another_order_fits(seed: int) -> None:
    vertices, faces = WHOLE
    order = np.random.default_rng(seed).permutation(len(vertices))
    copy = Placed(moved(vertices, seed)[order], np.argsort(order)[faces])
    assert misfit(Placed(vertices, faces), copy) < FITS


@settings(max_examples=5, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_a_misfit_is_the_same_both_ways(seed: int) -> None:
    vertices, faces = WHOLE
    bent = Placed(moved(creature(turn=15.0)[0], seed), creature(turn=15.0)[1])
    assert misfit(Placed(vertices, faces), bent) == misfit(bent, Placed(vertices, faces))


def test_another_mesh_of_the_same_surface_fits() -> None:
    vertices, faces = creature(offset=0.5)
    assert misfit(Placed(*WHOLE), Placed(moved(vertices, 3), faces)) < 2.0


def test_a_bent_neck_does_not_fit() -> None:
    vertices, faces = creature(turn=30.0)
    assert misfit(Placed(*WHOLE), Placed(moved(vertices, 3), faces)) > 3.0


def test_a_mirror_image_of_what_is_not_symmetric_does_not_fit() -> None:
    vertices, faces = creature(turn=30.0)  # looks to one side
    mirrored = Placed(vertices * [-1.0, 1.0, 1.0], faces[:, ::-1])
    assert misfit(Placed(vertices, faces), mirrored) > 3.0


def test_a_ball_and_a_sheet_fit_however_they_are_turned() -> None:
    for vertices, faces in (sphere(4), sheet(40)):
        large = 35.0 * vertices
        for seed in range(3):
            assert misfit(Placed(large, faces), Placed(moved(large, seed), faces)) < 3.0


def test_a_surface_that_is_there_fits_exactly() -> None:
    assert misfit(Placed(*WHOLE), Placed(*WHOLE)) == pytest.approx(0.0, abs=1e-6)
