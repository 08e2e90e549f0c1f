"""A triangle mesh with colour, as read: the one form in which every format arrives."""

from dataclasses import dataclass
from enum import StrEnum

from worker.arrays import ByteArray, FloatArray, IntArray


class Colour(StrEnum):
    """Where a mesh's colour came from."""

    TEXTURE = "texture"
    VERTEX = "vertex"
    FACE = "face"
    MATERIAL = "material"
    NONE = "none"


@dataclass(frozen=True, kw_only=True, eq=False)
class Mesh:
    """Triangles, each with its own colours, so that seams need no double vertices."""

    vertices: FloatArray  # (n, 3), in the file's own unit
    faces: IntArray  # (m, 3), indices of vertices
    corner_colours: FloatArray  # (m, 3, 3), sRGB in 0…1 at each corner; used where face_textures is -1
    corner_uvs: FloatArray  # (m, 3, 2), texture coordinates, v upwards, repeating; 0 where there are none
    face_textures: IntArray  # (m,), index into textures, or -1
    textures: tuple[ByteArray, ...]  # each (height, width, 3), sRGB, the first row is the top
    colour: Colour  # the richest source that any face uses
    warnings: tuple[str, ...]  # what was odd, in plain words
