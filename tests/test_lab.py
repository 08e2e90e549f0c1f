"""Lab is the one that the field's reference implementation gives."""

import warnings

import numpy as np

from worker.geometry.lab import D65, srgb_to_lab

with warnings.catch_warnings():  # colour warns that its plots need matplotlib; nothing is plotted here
    warnings.simplefilter("ignore")
    import colour


def test_lab_is_that_of_colour_science() -> None:
    generator = np.random.default_rng(0)
    anywhere = generator.uniform(-0.05, 1.05, (2_000, 3))
    dark = generator.uniform(0.0, 0.05, (2_000, 3))
    of_bytes = generator.integers(0, 256, (2_000, 3)) / 255.0
    srgb = np.concatenate([anywhere, dark, of_bytes])
    expected = colour.XYZ_to_Lab(colour.sRGB_to_XYZ(srgb), np.array(D65))
    np.testing.assert_allclose(srgb_to_lab(srgb), expected, atol=1e-9)


def test_any_shape_of_array_is_taken() -> None:
    srgb = np.random.default_rng(0).uniform(size=(4, 5, 3))
    np.testing.assert_array_equal(srgb_to_lab(srgb)[2, 3], srgb_to_lab(srgb[2, 3]))
