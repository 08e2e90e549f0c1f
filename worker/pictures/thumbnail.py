"""A picture of a mesh: shaded, coloured, on a transparent ground; no display or graphics card is needed."""

import io

import numpy as np
from PIL import Image

from worker.arrays import ByteArray, FloatArray, IntArray
from worker.geometry.colour import look_up_colours
from worker.geometry.repair import Repaired
from worker.pictures.camera import View, look_at
from worker.pictures.rasterising import Fragments, covered_pixels, rasterise
from worker.pictures.shading import corner_normals, shade
from worker.reading.mesh import Mesh

OVERSAMPLING = 2  # pixels of the render along one pixel of the picture
MOST_PAIRS = 15_000_000  # of triangle and pixel; a heap of huge triangles is drawn coarser than that


def thumbnail(mesh: Mesh, repaired: Repaired, size: int = 256) -> bytes:
    """Draw a mesh from three quarters, y upwards, framed by its bounding box.

    Parameters
    ----------
    mesh : Mesh
        Gives the colours.
    repaired : Repaired
        Gives the triangles.
    size : int
        The picture's width and height in pixels.

    Returns
    -------
    bytes
        A PNG with a transparent background.
    """
    view, side = _fitting_view(repaired, size * OVERSAMPLING)
    fragments = rasterise(view.pixels, view.depths, repaired.faces, side)
    colours = _surface_colours(mesh, repaired, view, fragments)
    normals = corner_normals(repaired.vertices, repaired.faces, fragments.faces)  # (k, 3, 3)
    seen = np.einsum("kc,kcd->kd", fragments.barycentrics, normals)
    return _png(_canvas(shade(colours, seen, view.axes), fragments.places, side), size)


def _fitting_view(repaired: Repaired, side: int) -> tuple[View, int]:
    """Frame the mesh at the given size, or at half of it again and again while that is too much work."""
    view = look_at(repaired.vertices, side)
    while side > 32 and covered_pixels(view.pixels, repaired.faces, side) > MOST_PAIRS:
        side //= 2
        view = look_at(repaired.vertices, side)
    return view, side


def _surface_colours(mesh: Mesh, repaired: Repaired, view: View, fragments: Fragments) -> FloatArray:
    sources = repaired.source_faces[fragments.faces]
    order = repaired.source_corners[fragments.faces]  # (k, 3)
    barycentrics = np.zeros_like(fragments.barycentrics)
    np.put_along_axis(barycentrics, order, fragments.barycentrics, axis=1)
    first, second, third = np.moveaxis(view.pixels[repaired.faces[fragments.faces]], 1, 0)  # each (k, 2)
    (a, b), (c, d) = (second - first).T, (third - first).T
    footprints = np.minimum(
        2.0 / np.maximum(np.abs(a * d - b * c), 1e-12), 1.0
    )  # one pixel's share of the face
    return look_up_colours(mesh, sources, barycentrics, footprints)


def _canvas(colours: FloatArray, places: IntArray, side: int) -> FloatArray:
    canvas = np.zeros((side * side, 4))
    canvas[places, :3], canvas[places, 3] = colours, 1.0
    return canvas.reshape(side, side, 4)


def _png(canvas: FloatArray, size: int) -> bytes:
    """Average blocks of pixels, covered ones only for the colour, and write them."""
    side = len(canvas)
    block = max(side // size, 1)
    corners = [canvas[row::block, column::block] for row, column in np.ndindex(block, block)]
    sums = np.sum(corners, axis=0) / block**2
    alpha = sums[..., 3:]
    pixels: ByteArray = np.rint(
        255 * np.concatenate([sums[..., :3] / np.maximum(alpha, 1e-9), alpha], 2)
    ).astype(np.uint8)
    picture = Image.fromarray(pixels, "RGBA")
    if len(pixels) != size:
        picture = picture.resize((size, size), Image.Resampling.BILINEAR)
    file = io.BytesIO()
    picture.save(file, "PNG")
    return file.getvalue()
