"""Each change of light does to Lab what it says, alike at corners and in images."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from service.evaluation.photometric import (
    CHANGES,
    DEVIATION,
    NOISE,
    PHOTOMETRIC,
    lab_to_srgb,
    mean_lightness,
    recolour,
)
from tests.evaluations import textured_box
from tests.shapes import coloured, sphere
from worker.arrays import FloatArray
from worker.geometry.colour import srgb_to_lab
from worker.reading.mesh import Mesh

STRENGTHS = (1, 2, 3, 4, 5)
SIGNS = {"+": 1, "-": -1}


def patchwork(spread: tuple[float, float, float], seed: int = 0) -> Mesh:
    """Return a sphere with one colour to a triangle, about the middle of Lab: L 50, no chroma."""
    vertices, faces = sphere(2)
    offsets = np.random.default_rng(seed).uniform(-1, 1, (len(faces), 3)) * spread
    srgb = np.rint(255 * lab_to_srgb([50.0, 0.0, 0.0] + offsets)) / 255
    mesh = coloured(vertices, faces, np.zeros_like(vertices))
    return replace(mesh, corner_colours=np.repeat(srgb[:, None], 3, axis=1))


def lab_of(mesh: Mesh) -> FloatArray:
    return srgb_to_lab(mesh.corner_colours.reshape(-1, 3))


def changed(mesh: Mesh, change: str, strength: int, seed: int = 0) -> Mesh:
    return recolour(mesh, change, strength, np.random.default_rng(seed))


@given(st.integers(0, 2**32 - 1))
def test_lab_to_srgb_inverts_srgb_to_lab_inside_the_gamut(seed: int) -> None:
    srgb = np.random.default_rng(seed).uniform(0, 1, (50, 3))
    a_sixth_of_a_step = 1 / 255 / 6  # the standard prints its two matrices to four digits
    np.testing.assert_allclose(lab_to_srgb(srgb_to_lab(srgb)), srgb, atol=a_sixth_of_a_step)


def test_colours_outside_the_gamut_are_clipped() -> None:
    srgb = lab_to_srgb(np.array([[50.0, 120.0, 0.0], [140.0, 0.0, 0.0], [-20.0, 0.0, 0.0]]))
    assert srgb.min() >= 0.0
    assert srgb.max() <= 1.0
    np.testing.assert_allclose(srgb[1:], [[1, 1, 1], [0, 0, 0]])


@pytest.mark.parametrize("strength", STRENGTHS)
@pytest.mark.parametrize("sign", SIGNS)
def test_brightness_shifts_the_mean_of_l_by_8_for_each_strength(sign: str, strength: int) -> None:
    mesh = patchwork((5.0, 2.0, 2.0))
    shift = mean_lightness(changed(mesh, f"brightness{sign}", strength)) - mean_lightness(mesh)
    assert shift == pytest.approx(SIGNS[sign] * 8.0 * strength, abs=0.1)


@pytest.mark.parametrize("strength", STRENGTHS)
@pytest.mark.parametrize("sign", SIGNS)
def test_contrast_keeps_the_mean_of_l_and_scales_what_differs_from_it(sign: str, strength: int) -> None:
    mesh = patchwork((20.0, 1.0, 1.0))
    after = changed(mesh, f"contrast{sign}", strength)
    assert mean_lightness(after) == pytest.approx(mean_lightness(mesh), abs=0.1)
    factor = 1.0 + SIGNS[sign] * 0.16 * strength
    expected = (lab_of(mesh)[:, 0] - mean_lightness(mesh)) * factor
    np.testing.assert_allclose(lab_of(after)[:, 0] - mean_lightness(mesh), expected, atol=0.5)


@pytest.mark.parametrize("strength", STRENGTHS)
def test_hue_shifts_a_by_12_for_each_strength_and_nothing_else(strength: int) -> None:
    mesh = patchwork((5.0, 5.0, 5.0))
    shifts = lab_of(changed(mesh, "hue", strength)) - lab_of(mesh)
    np.testing.assert_allclose(shifts.mean(axis=0), [0.0, 12.0 * strength, 0.0], atol=0.3)
    np.testing.assert_allclose(shifts - shifts.mean(axis=0), 0.0, atol=1.0)


@pytest.mark.parametrize("strength", STRENGTHS)
@pytest.mark.parametrize(("change", "slope"), [("saturation+", 0.3), ("saturation-", -0.19)])
def test_saturation_scales_a_and_b_and_keeps_l(change: str, slope: float, strength: int) -> None:
    mesh = patchwork((10.0, 8.0, 8.0))
    before, after = lab_of(mesh), lab_of(changed(mesh, change, strength))
    np.testing.assert_allclose(after[:, 0], before[:, 0], atol=0.5)
    np.testing.assert_allclose(after[:, 1:], (1.0 + slope * strength) * before[:, 1:], atol=1.0)


@pytest.mark.parametrize("strength", [1, 2])
def test_noise_deviates_by_4_for_each_strength_in_every_channel(strength: int) -> None:
    vertices, faces = sphere(4)
    mesh = coloured(vertices, faces, np.full_like(vertices, 0.5))
    after = changed(mesh, NOISE, strength)
    at_vertices = np.empty_like(vertices)
    at_vertices[faces.ravel()] = lab_of(after) - lab_of(mesh)
    np.testing.assert_allclose(at_vertices.std(axis=0), DEVIATION * strength, rtol=0.06)
    np.testing.assert_allclose(at_vertices.mean(axis=0), 0.0, atol=0.1 * DEVIATION * strength)


def test_noise_is_the_same_at_all_corners_of_a_vertex() -> None:
    vertices, faces = sphere(2)
    after = changed(coloured(vertices, faces, np.full_like(vertices, 0.5)), NOISE, 3)
    at_vertices = np.empty_like(vertices)
    at_vertices[faces.ravel()] = after.corner_colours.reshape(-1, 3)
    np.testing.assert_array_equal(after.corner_colours, at_vertices[faces])
    assert len(np.unique(at_vertices, axis=0)) > 0.9 * len(vertices)


def test_noise_is_another_in_each_texel() -> None:
    mesh = replace(textured_box(), textures=(np.full((32, 32, 3), 128, dtype=np.uint8),))
    texels = changed(mesh, NOISE, 2).textures[0].reshape(-1, 3) / 255.0
    np.testing.assert_allclose(srgb_to_lab(texels).std(axis=0), 2 * DEVIATION, rtol=0.1)


@pytest.mark.parametrize("change", PHOTOMETRIC)
def test_more_strength_changes_colours_more(change: str) -> None:
    mesh = patchwork((20.0, 15.0, 15.0))
    before = lab_of(mesh)
    moved = [np.linalg.norm(lab_of(changed(mesh, change, s)) - before, axis=1).mean() for s in STRENGTHS]
    assert (np.diff([0.0, *moved]) > 0).all()


@pytest.mark.parametrize("change", CHANGES)
def test_images_are_changed_like_corners(change: str) -> None:
    after = changed(textured_box(), change, 3)
    np.testing.assert_array_equal(np.rint(255 * after.corner_colours).reshape(6, 6, 3), after.textures[0])


@pytest.mark.parametrize("change", PHOTOMETRIC)
def test_only_colours_change_and_come_in_steps_of_8_bits(change: str) -> None:
    mesh = textured_box()
    kept, texels = mesh.corner_colours.copy(), mesh.textures[0].copy()
    after = changed(mesh, change, 2)
    for field in ("vertices", "faces", "corner_uvs", "face_textures", "colour"):
        assert getattr(after, field) is getattr(mesh, field)
    np.testing.assert_allclose(255 * after.corner_colours, np.rint(255 * after.corner_colours), atol=1e-9)
    assert after.textures[0].dtype == np.uint8
    np.testing.assert_array_equal(mesh.corner_colours, kept)
    np.testing.assert_array_equal(mesh.textures[0], texels)
