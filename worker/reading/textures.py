"""Images become arrays of sRGB bytes, through Pillow: the size is checked before a pixel is read."""

import io
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from threading import Lock

import numpy as np
from PIL import Image

from worker.arrays import ByteArray, FloatArray
from worker.errors import Code, MeshError
from worker.reading.limits import Limits
from worker.reading.showing import shown

# What textures come in. Pillow's other readers start programs (EPS) or are little tried.
FORMATS = ("PNG", "JPEG", "BMP", "TGA", "TIFF", "WEBP", "GIF", "JPEG2000", "PPM", "DDS", "PCX")

_SIXTEEN_BITS = 65535.0
_THIRTY_TWO_BITS = 2147483647.0
_quiet = Lock()


def check_image(data: bytes, name: str, limits: Limits) -> None:
    """Refuse an image by its header alone.

    Parameters
    ----------
    data : bytes
        The file.
    name : str
        Its path in the upload, for the message.
    limits : Limits
        The most pixels.

    Raises
    ------
    MeshError
        BAD_IMAGE where it is none, IMAGE_TOO_LARGE
    """
    with _refusals(name, limits):
        _open(data, name, limits)


def read_image(data: bytes, name: str, limits: Limits) -> ByteArray:
    """Decode an image; transparency is dropped.

    Parameters
    ----------
    data, name, limits
        As in `check_image`.

    Returns
    -------
    ByteArray
        (height, width, 3), sRGB, the first row is the top.

    Raises
    ------
    MeshError
        BAD_IMAGE, IMAGE_TOO_LARGE
    """
    with _refusals(name, limits):
        image = _open(data, name, limits)
        image.load()
        return _to_bytes(image)


@contextmanager
def _refusals(name: str, limits: Limits) -> Iterator[None]:
    """Turn whatever Pillow raises into a refusal, and keep its warnings to itself."""
    try:
        # Filters of warnings belong to the whole process: one thread at a time may change them.
        with _quiet, warnings.catch_warnings():
            warnings.simplefilter("ignore")  # Pillow's own limit warns; ours refuses
            yield
    except (MeshError, MemoryError):
        raise
    except Image.DecompressionBombError:
        raise MeshError(
            Code.IMAGE_TOO_LARGE, f"The image {shown(name)} has more than {limits.image_pixels:,} pixels."
        ) from None
    except Exception as error:  # Pillow raises whatever its readers stumble over
        raise MeshError(
            Code.BAD_IMAGE, f"Expected an image (PNG, JPEG, TIFF …) in {shown(name)}, but it cannot be read."
        ) from error


def _open(data: bytes, name: str, limits: Limits) -> Image.Image:
    image = Image.open(io.BytesIO(data), formats=FORMATS)
    width, height = image.size
    if width * height > limits.image_pixels:
        raise MeshError(
            Code.IMAGE_TOO_LARGE,
            f"The image {shown(name)} has {width} by {height} pixels; "
            f"at most {limits.image_pixels:,} are read.",
        )
    return image


def _to_bytes(image: Image.Image) -> ByteArray:
    """Convert any mode by its declared range: whole numbers by their maximum, floats from 0…1."""
    if image.mode.startswith("I;16"):
        return _grey(np.asarray(image).astype(np.float64) / _SIXTEEN_BITS)
    if image.mode == "I":
        # Pillow opens 16-bit PNG and PGM in this mode too.
        most = _SIXTEEN_BITS if image.format in {"PNG", "PPM"} else _THIRTY_TWO_BITS
        return _grey(np.asarray(image).astype(np.float64) / most)
    if image.mode == "F":
        return _grey(np.nan_to_num(np.asarray(image).astype(np.float64)))
    if image.mode in {"P", "PA"}:
        image = image.convert("RGBA")
    return np.asarray(image.convert("RGB"), dtype=np.uint8)


def _grey(levels: FloatArray) -> ByteArray:
    """Return levels in 0…1 (height, width) as three equal channels."""
    rounded = np.rint(np.clip(levels, 0.0, 1.0) * 255.0).astype(np.uint8)
    return np.repeat(rounded[:, :, None], 3, axis=2)
