"""The z-buffer agrees with a pixel-by-pixel look at every triangle."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from worker.arrays import FloatArray, IntArray
from worker.pictures.rasterising import covered_pixels, rasterise


def _brute_force(pixels: FloatArray, depths: FloatArray, faces: IntArray, size: int) -> FloatArray:
    """Return the least depth at each pixel, infinite where nothing is seen."""
    nearest = np.full((size, size), np.inf)
    for face in faces:
        matrix = np.vstack([pixels[face].T, np.ones(3)])
        if abs(np.linalg.det(matrix)) < 1e-9:
            continue
        for row in range(size):
            for column in range(size):
                weights = np.linalg.solve(matrix, [column + 0.5, row + 0.5, 1.0])
                if weights.min() >= 0:
                    nearest[row, column] = min(nearest[row, column], weights @ depths[face])
    return nearest


@given(seed=st.integers(0, 10_000))
@settings(max_examples=25)
def test_the_nearest_triangle_is_seen_at_every_pixel(seed: int) -> None:
    generator = np.random.default_rng(seed)
    size, pixels = 7, generator.uniform(-3, 10, (9, 2))
    depths, faces = generator.uniform(0, 1, 9), np.arange(9).reshape(3, 3)
    seen = rasterise(pixels, depths, faces, size)
    found = np.full(size * size, np.inf)
    found[seen.places] = (seen.barycentrics * depths[faces[seen.faces]]).sum(1)
    np.testing.assert_allclose(
        found.reshape(size, size), _brute_force(pixels, depths, faces, size), atol=1e-9
    )


def test_barycentrics_give_the_pixel_centre_back() -> None:
    pixels, faces = np.array([(1.0, 1.0), (9.0, 2.0), (3.0, 8.0)]), np.array([(0, 1, 2)])
    seen = rasterise(pixels, np.zeros(3), faces, 10)
    centres = np.stack([seen.places % 10, seen.places // 10], axis=1) + 0.5
    np.testing.assert_allclose(seen.barycentrics @ pixels, centres, atol=1e-12)
    np.testing.assert_allclose(seen.barycentrics.sum(1), 1.0)


def test_two_triangles_of_a_square_leave_no_gap() -> None:
    pixels = np.array([(0.0, 0.0), (8.0, 0.0), (8.0, 8.0), (0.0, 8.0)])
    seen = rasterise(pixels, np.zeros(4), np.array([(0, 1, 2), (0, 2, 3)]), 8)
    np.testing.assert_array_equal(seen.places, np.arange(64))


def test_the_work_is_the_pixels_of_the_bounding_boxes() -> None:
    pixels = np.array([(0.0, 0.0), (4.0, 0.0), (0.0, 3.0)])
    assert covered_pixels(pixels, np.array([(0, 1, 2)]), 10) == 12


def test_what_lies_outside_the_picture_is_not_seen() -> None:
    pixels = np.array([(20.0, 0.0), (24.0, 0.0), (20.0, 3.0)])
    assert len(rasterise(pixels, np.zeros(3), np.array([(0, 1, 2)]), 10).places) == 0
