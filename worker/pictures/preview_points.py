"""A preview's points: vertices, triangles and colours of a GLB that `worker.pictures.preview` wrote."""

import json
import struct
from typing import Any

import numpy as np
import numpy.typing as npt

from worker.arrays import FloatArray, IntArray

_HEADER = struct.Struct("<4sII")  # magic, version, length of the file
_CHUNK = struct.Struct("<I4s")  # length, kind
_TYPES = {5126: "<f4", 5125: "<u4", 5123: "<u2", 5121: "<u1"}  # component types, glTF 2.0, section 3.6.2.2


class NoPreview(Exception):
    """The bytes are no GLB with one mesh of triangles."""


def read_points(glb: bytes) -> tuple[FloatArray, IntArray]:
    """Return vertices (n, 3) and faces (m, 3) of a preview, in units of the canonical surface.

    Raises
    ------
    NoPreview
    """
    try:
        document, numbers = _chunks(glb)
        primitive = document["meshes"][0]["primitives"][0]
        vertices = _accessed(document, numbers, primitive["attributes"]["POSITION"]).reshape(-1, 3)
        faces = _accessed(document, numbers, primitive["indices"]).reshape(-1, 3)
    except (KeyError, IndexError, TypeError, ValueError, struct.error) as error:
        raise NoPreview(f"a preview could not be read: {error!r}") from error
    if faces.size == 0 or faces.max() >= len(vertices) or not np.isfinite(vertices).all():
        raise NoPreview(f"the preview's {len(faces)} triangles and {len(vertices)} vertices do not fit")
    return vertices.astype(np.float64), faces.astype(np.int64)


def read_colours(glb: bytes) -> FloatArray:
    """Return the sRGB (n, 3), 0…1, of a preview's vertices, as exact as 8 linear bits are.

    Raises
    ------
    NoPreview
    """
    try:
        document, numbers = _chunks(glb)
        place = document["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"]
        linear = _accessed(document, numbers, place).reshape(-1, 4)[:, :3].astype(np.float64) / 255.0
    except (KeyError, IndexError, TypeError, ValueError, struct.error) as error:
        raise NoPreview(f"a preview's colours could not be read: {error!r}") from error
    return np.asarray(np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055))


def _chunks(glb: bytes) -> tuple[dict[str, Any], memoryview]:
    """Return the document of a GLB and its numbers."""
    magic, version, size = _HEADER.unpack_from(glb)
    if magic != b"glTF" or version != 2 or size != len(glb):
        raise ValueError(f"it begins with {magic!r}, version {version}, {size} bytes; it has {len(glb)}")
    length, _ = _CHUNK.unpack_from(glb, _HEADER.size)
    start = _HEADER.size + _CHUNK.size
    document: dict[str, Any] = json.loads(glb[start : start + length])
    return document, memoryview(glb)[start + length + _CHUNK.size :]


def _accessed(document: dict[str, Any], numbers: memoryview, place: int) -> npt.NDArray[Any]:
    accessor = document["accessors"][place]
    view = document["bufferViews"][accessor["bufferView"]]
    kind = np.dtype(_TYPES[accessor["componentType"]])
    start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    return np.frombuffer(numbers, kind, view["byteLength"] // kind.itemsize, start)
