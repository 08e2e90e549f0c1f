"""Pictures made smaller keep their look."""

import io

import numpy as np
import numpy.typing as npt
import pytest
from PIL import Image

from worker.pictures.smaller import smaller


def png(pixels: npt.NDArray[np.uint8]) -> bytes:
    file = io.BytesIO()
    Image.fromarray(pixels, "RGBA").save(file, "PNG")
    return file.getvalue()


def read(picture: bytes) -> npt.NDArray[np.float64]:
    return np.asarray(Image.open(io.BytesIO(picture)).convert("RGBA"), np.float64)


def disc(side: int) -> npt.NDArray[np.uint8]:
    """Return a white disc on transparent black."""
    y, x = np.mgrid[:side, :side] - (side - 1) / 2
    pixels = np.zeros((side, side, 4), np.uint8)
    pixels[np.hypot(x, y) < 0.4 * side] = 255
    return pixels


@pytest.mark.parametrize("width", [32, 96, 160, 255])
def test_it_has_the_width_that_was_asked_for(width: int) -> None:
    assert read(smaller(png(disc(256)), width)).shape == (width, width, 4)


def test_what_is_no_wider_comes_back_as_it_is() -> None:
    picture = png(disc(64))
    assert smaller(picture, 64) is picture
    assert smaller(picture, 256) is picture


def test_the_rim_is_as_light_as_the_inside() -> None:
    found = read(smaller(png(disc(256)), 96))
    rim = (found[..., 3] > 30) & (found[..., 3] < 225)
    assert rim.sum() > 50
    assert found[rim][:, :3].min() > 225  # averages that take in the black underneath give half of it


def test_colours_and_opacity_stay() -> None:
    ramp = np.zeros((256, 256, 4), np.uint8)
    ramp[..., 0], ramp[..., 1] = np.arange(256)[:, None], 120
    ramp[..., 3] = 255
    found = read(smaller(png(ramp), 64))
    expected = ramp.reshape(64, 4, 64, 4, 4).mean(axis=(1, 3))
    assert np.abs(found - expected)[2:-2, 2:-2].mean() < 4


def test_it_takes_fewer_bytes() -> None:
    random = np.random.default_rng(0)
    noisy = disc(256)
    noisy[..., :3] = np.clip(noisy[..., :3] * random.uniform(0.7, 1, (256, 256, 1)), 0, 255)
    assert len(smaller(png(noisy), 160)) < len(png(noisy)) / 2
