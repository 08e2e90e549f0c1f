"""What a file says, before textures are opened: polygons with the names of their colours."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from worker.arrays import BoolArray, FloatArray, IntArray
from worker.errors import Code, MeshError
from worker.reading.showing import shown

LARGEST = 1e100  # products of three larger numbers overflow


@dataclass(frozen=True, kw_only=True)
class TextureMap:
    """An image laid over faces."""

    reference: str  # the name as the file writes it
    named_by: str  # path in the upload of the file that names it
    scale: tuple[float, float] = (1.0, 1.0)  # texture coordinates are multiplied by this
    offset: tuple[float, float] = (0.0, 0.0)  # and then moved by this


@dataclass(frozen=True, kw_only=True)
class Material:
    """The colour of a group of faces."""

    name: str  # as the mesh uses it
    colour: tuple[float, float, float] | None = None  # sRGB in 0…1
    texture: TextureMap | None = None  # takes the place of the colour


@dataclass(frozen=True, kw_only=True, eq=False)
class Surface:
    """Polygons as a file lists them."""

    vertices: FloatArray  # (n, 3)
    corners: IntArray  # (k,), indices of vertices, polygon after polygon
    counts: IntArray  # (f,), corners of each polygon, at least 3
    corner_uvs: FloatArray  # (k, 2), texture coordinates, v upwards; 0 where there are none
    face_has_uvs: BoolArray  # (f,), every corner has texture coordinates
    face_materials: IntArray  # (f,), index into materials, or -1
    materials: tuple[Material, ...]
    vertex_colours: FloatArray | None  # (n, 3), sRGB in 0…1
    face_colours: FloatArray | None  # (f, 3), sRGB in 0…1
    warnings: tuple[str, ...]


def check_indices(corners: IntArray, n_vertices: int, what: str = "vertex") -> None:
    """Refuse indices (from 0) that name nothing.

    Raises
    ------
    MeshError
        INDEX_OUT_OF_RANGE
    """
    wrong = (corners < 0) | (corners >= n_vertices)
    if wrong.any():
        number = int(corners[np.argmax(wrong)])
        raise MeshError(
            Code.INDEX_OUT_OF_RANGE,
            f"A face names {what} {number} (counted from 0), but the file has {n_vertices} of them.",
        )


def check_finite(values: FloatArray, what: str) -> None:
    """Refuse rows of numbers that are not finite, or too large to be multiplied.

    Raises
    ------
    MeshError
        NON_FINITE
    """
    wrong = ~(np.abs(values) <= LARGEST).all(axis=-1)  # NaN is not smaller than anything
    if wrong.any():
        raise MeshError(
            Code.NON_FINITE,
            f"Expected finite {what}, but {int(wrong.sum())} of {wrong.size} hold NaN, infinity or a number "
            f"beyond {LARGEST:g}; the first is number {int(np.argmax(wrong)) + 1}.",
        )


def among(names: Sequence[str], what: str) -> list[str]:
    """Return one warning for names of which there may be thousands, or none."""
    if not names:
        return []
    first = ", ".join(shown(name, 60) for name in names[:3])
    return [f"{len(names)} {what}: {first}{' …' if len(names) > 3 else ''}"]
