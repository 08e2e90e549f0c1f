"""Images become arrays of sRGB bytes, through Pillow: the size is checked before a pixel is read."""

import io
import warnings

import numpy as np
from PIL import Image

from worker.arrays import ByteArray, FloatArray
from worker.errors import Code, MeshError
from worker.reading.limits import Limits

# What textures come in. Pillow's other readers start programs (EPS) or are little tried.
FORMATS = ("PNG", "JPEG", "BMP", "TGA", "TIFF", "WEBP", "GIF", "JPEG2000", "PPM", "DDS", "PCX")

_SIXTEEN_BITS = 65535.0
_THIRTY_TWO_BITS = 2147483647.0


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
    _open(data, name, limits)


def read_image(data: bytes, name: str, limits: Limits) -> ByteArray:
    """Decode an image; transparency is dropped.

    Returns
    -------
    ByteArray
        (height, width, 3), sRGB, the first row is the top.

    Raises
    ------
    MeshError
        BAD_IMAGE, IMAGE_TOO_LARGE
    """
    image = _open(data, name, limits)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of the image's metadata, which is not used
            image.load()
            return _to_bytes(image)
    except MemoryError:
        raise
    except Exception as error:  # noqa: BLE001 -- Pillow raises whatever its readers stumble over
        raise MeshError(Code.BAD_IMAGE, f"The image “{name}” is damaged: {error}.") from error


def _open(data: bytes, name: str, limits: Limits) -> Image.Image:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # Pillow's own limit warns; ours refuses
            image = Image.open(io.BytesIO(data), formats=FORMATS)
    except Image.DecompressionBombError:
        raise MeshError(
            Code.IMAGE_TOO_LARGE, f"The image “{name}” has more than {limits.image_pixels:,} pixels."
        ) from None
    except Exception as error:  # noqa: BLE001 -- Pillow raises whatever its readers stumble over
        raise MeshError(
            Code.BAD_IMAGE, f"Expected an image in “{name}” (PNG, JPEG, TIFF …), but it cannot be read."
        ) from error
    width, height = image.size
    if width * height > limits.image_pixels:
        raise MeshError(
            Code.IMAGE_TOO_LARGE,
            f"The image “{name}” has {width} × {height} pixels; at most {limits.image_pixels:,} are read.",
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
