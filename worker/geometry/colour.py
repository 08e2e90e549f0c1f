"""The colour of a surface: looked up in its source, in CIE Lab."""

import warnings

import numpy as np
from PIL import Image

from worker.arrays import ByteArray, FloatArray, IntArray
from worker.reading.mesh import Mesh

with warnings.catch_warnings():  # colour warns that its plots need matplotlib; nothing is plotted here
    warnings.simplefilter("ignore")
    import colour

D65 = (0.3127, 0.3290)  # chromaticity of the white point of sRGB and of our Lab


def srgb_to_lab(srgb: FloatArray) -> FloatArray:
    """Convert sRGB to CIE Lab.

    Parameters
    ----------
    srgb : (n, 3) array
        Encoded (non-linear) sRGB in 0…1.

    Returns
    -------
    (n, 3) array
        L in 0…100, a, b; white point D65 (IEC 61966-2-1, CIE 15).
    """
    xyz = colour.sRGB_to_XYZ(srgb)
    return np.asarray(colour.XYZ_to_Lab(xyz, np.array(D65)), dtype=np.float64)


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
    colours: FloatArray = np.einsum("kc,kcd->kd", barycentrics, mesh.corner_colours[face_indices])  # (k, 3)
    if not mesh.textures:
        return colours
    uvs = np.einsum("kc,kcd->kd", barycentrics, mesh.corner_uvs[face_indices])  # (k, 2)
    textures = mesh.face_textures[face_indices]  # (k,)
    for number, texture in enumerate(mesh.textures):
        inside = np.flatnonzero(textures == number)
        if len(inside) == 0:
            continue
        if footprints is None:
            colours[inside] = _nearest(texture, uvs[inside]) / 255.0
        else:
            levels = _levels(mesh.corner_uvs[face_indices[inside]], footprints[inside], texture)
            colours[inside] = _filtered(texture, uvs[inside], levels) / 255.0
    return colours


def _levels(corner_uvs: FloatArray, footprints: FloatArray, texture: ByteArray) -> FloatArray:
    """Return the level of the image pyramid whose texels are about as large as each point's footprint."""
    height, width = texture.shape[:2]
    first = corner_uvs[:, 1] - corner_uvs[:, 0]
    second = corner_uvs[:, 2] - corner_uvs[:, 0]
    texels = np.abs(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]) / 2 * width * height * footprints
    return np.asarray(np.floor(np.log2(np.maximum(texels, 1.0)) / 2))


def _nearest(texture: ByteArray, uvs: FloatArray) -> FloatArray:
    """Read the texel that each point lies in; coordinates repeat."""
    height, width = texture.shape[:2]
    column = np.floor((uvs[:, 0] % 1.0) * width).astype(np.int64) % width
    row = np.floor(((1.0 - uvs[:, 1]) % 1.0) * height).astype(np.int64) % height
    return np.asarray(texture[row, column], dtype=np.float64)


def _filtered(texture: ByteArray, uvs: FloatArray, levels: FloatArray) -> FloatArray:
    """Read a texture bilinearly at each point's level of its pyramid; coordinates repeat."""
    colours = np.empty((len(uvs), 3))
    image = Image.fromarray(texture)
    last = int(np.log2(max(min(texture.shape[:2]), 1)))
    levels = np.minimum(levels, last)
    for level in np.unique(levels):
        inside = np.flatnonzero(levels == level)
        reduced = np.asarray(image.reduce(2 ** int(level)) if level else image)
        colours[inside] = _bilinear(reduced, uvs[inside])
    return colours


def _bilinear(image: ByteArray, uvs: FloatArray) -> FloatArray:
    """Interpolate an image at texture coordinates, v upwards, repeating."""
    height, width = image.shape[:2]
    x = (uvs[:, 0] % 1.0) * width - 0.5
    y = ((1.0 - uvs[:, 1]) % 1.0) * height - 0.5
    left, top = np.floor(x).astype(np.int64), np.floor(y).astype(np.int64)
    right_share, bottom_share = (x - left)[:, None], (y - top)[:, None]
    upper = image[top % height, left % width] * (1 - right_share)
    upper += image[top % height, (left + 1) % width] * right_share
    lower = image[(top + 1) % height, left % width] * (1 - right_share)
    lower += image[(top + 1) % height, (left + 1) % width] * right_share
    return np.asarray(upper * (1 - bottom_share) + lower * bottom_share)
