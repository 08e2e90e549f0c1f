"""Images of any kind become the bytes that they show."""

import io
import struct
import zlib

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from tests.mesh_files import attempt, png
from worker.errors import Code, MeshError
from worker.reading.limits import Limits
from worker.reading.textures import check_image, read_image

LEVELS = np.array([[0, 128], [200, 255]], dtype=np.uint8)


def saved(image: Image.Image, form: str = "PNG") -> bytes:
    stream = io.BytesIO()
    image.save(stream, form)
    return stream.getvalue()


def claiming(width: int, height: int) -> bytes:
    """Return a PNG whose header claims a size that its data do not have."""
    header = b"IHDR" + struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    start = b"\x89PNG\r\n\x1a\n" + struct.pack(">I", 13) + header + struct.pack(">I", zlib.crc32(header))
    return start + struct.pack(">I", 8) + b"IDAT"


def refused(data: bytes) -> Code:
    with pytest.raises(MeshError) as caught:
        read_image(data, "t.png", Limits())
    return caught.value.code


@pytest.mark.parametrize("mode", ["RGB", "RGBA", "L", "LA", "P", "1", "I;16"])
def test_every_mode_shows_the_same_grey(mode: str) -> None:
    grey = LEVELS if mode != "1" else (LEVELS > 150).astype(np.uint8) * 255
    if mode == "I;16":
        image = Image.fromarray(grey.astype(np.uint16) * 257)
    else:
        image = Image.fromarray(grey).convert(mode)
    found = read_image(saved(image), "t.png", Limits())
    assert found.dtype == np.uint8
    np.testing.assert_array_equal(found, np.repeat(grey[:, :, None], 3, axis=2))


def test_transparency_hides_no_colour() -> None:
    pixels = np.array([[[200, 100, 50, 0], [1, 2, 3, 128]]], dtype=np.uint8)
    found = read_image(saved(Image.fromarray(pixels)), "t.png", Limits())
    np.testing.assert_array_equal(found, pixels[:, :, :3])


def test_a_palette_with_transparent_entries_is_read_without_a_warning() -> None:
    image = Image.fromarray(LEVELS).convert("P")
    image.info["transparency"] = b"\x00\x80\xff"
    stream = io.BytesIO()
    image.save(stream, "PNG", transparency=b"\x00\x80\xff")
    found = read_image(stream.getvalue(), "t.png", Limits())
    np.testing.assert_array_equal(found[:, :, 0], LEVELS)


def test_print_colours_become_screen_colours() -> None:
    image = Image.new("CMYK", (2, 2), (0, 255, 255, 0))
    assert read_image(saved(image, "TIFF"), "t.tif", Limits())[0, 0].tolist() == [255, 0, 0]


def test_floats_are_taken_from_zero_to_one() -> None:
    image = Image.fromarray(np.array([[0.0, 0.5, 2.0]], dtype=np.float32))
    assert read_image(saved(image, "TIFF"), "t.tif", Limits())[0, :, 0].tolist() == [0, 128, 255]


@pytest.mark.parametrize("size", [(50_000, 50_000), (13_000, 13_000), (65_000, 65_000), (40_000_001, 1)])
def test_an_image_is_refused_for_its_size_before_a_pixel_is_read(size: tuple[int, int]) -> None:
    assert refused(claiming(*size)) == Code.IMAGE_TOO_LARGE
    with pytest.raises(MeshError, match="pixels"):
        check_image(claiming(*size), "t.png", Limits())


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"<html></html>",
        b"<svg xmlns='http://www.w3.org/2000/svg'/>",
        b"%!PS-Adobe-3.0 EPSF-3.0\n",
        png()[:50],
    ],
)
def test_what_is_no_whole_image_is_refused(data: bytes) -> None:
    assert refused(data) == Code.BAD_IMAGE


def test_a_cut_image_passes_by_its_header_alone() -> None:
    check_image(png()[:50], "t.png", Limits())


@given(st.integers(0, 60), st.integers(0, 255), st.integers(20, 80))
def test_a_damaged_image_is_read_or_refused(place: int, byte: int, length: int) -> None:
    data = bytearray(png())
    data[place] = byte
    kinds = {None, Code.BAD_IMAGE, Code.IMAGE_TOO_LARGE}
    assert attempt(lambda: read_image(bytes(data[:length]), "t.png", Limits())) in kinds
