"""The colour of a surface, looked up in its source."""

import numpy as np
from PIL import Image

from worker.arrays import ByteArray, FloatArray, IntArray
from worker.geometry.lab import D65, srgb_to_lab
from worker.geometry.texels import interpolate, levels_of, read_between, read_nearest
from worker.reading.mesh import Mesh

__all__ = ["D65", "look_up_colours", "srgb_to_lab"]


def look_up_colours(
    mesh: Mesh, face_indices: IntArray, barycentrics: FloatArray, footprints: FloatArray | None = None
) -> FloatArray:
    """Look up the colour at points of a mesh.

    Parameters
    ----------
    mesh : Mesh
        The mesh as read.
    face_indices : (k,) array
        The face of each point.
    barycentrics : (k, 3) array
        Its barycentric coordinates there.
    footprints : (k,) array, optional
        The share of its face's area that each point stands for: a texture is averaged over so much
        (mip-mapping, Williams 1983). Without it the nearest texel is taken.

    Returns
    -------
    (k, 3) array
        sRGB in 0…1.
    """
    colours = interpolate(mesh.corner_colours, face_indices, barycentrics)  # (k, 3)
    if not mesh.textures:
        return colours
    uvs = interpolate(mesh.corner_uvs, face_indices, barycentrics)  # (k, 2)
    textures = mesh.face_textures[face_indices]  # (k,)
    for number, texture in enumerate(mesh.textures):
        inside = np.flatnonzero(textures == number)
        if len(inside) == 0:
            continue
        if footprints is None:
            read_nearest(texture, uvs, inside, colours)
        else:
            n_texels = texture.shape[0] * texture.shape[1]
            levels = levels_of(mesh.corner_uvs, face_indices[inside], footprints[inside], n_texels)
            _read_pyramid(texture, uvs, inside, levels, colours)
    return colours


def _read_pyramid(
    texture: ByteArray, uvs: FloatArray, inside: IntArray, levels: IntArray, colours: FloatArray
) -> None:
    """Read a texture at some points, each at its own level of the pyramid of ever smaller images."""
    image = Image.fromarray(texture)
    last = int(np.log2(max(min(texture.shape[:2]), 1)))
    levels = np.minimum(levels, last)
    for level in np.flatnonzero(np.bincount(levels)):
        reduced = np.asarray(image.reduce(2 ** int(level))) if level else texture
        read_between(reduced, uvs, inside[levels == level], colours)
