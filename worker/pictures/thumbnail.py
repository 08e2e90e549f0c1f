"""A picture of a mesh: shaded, coloured, on a transparent ground; no display or graphics card is needed."""

import io

import numpy as np
from PIL import Image

from worker.arrays import ByteArray, FloatArray, IntArray
from worker.compiled import compiled
from worker.geometry.colour import look_up_colours
from worker.geometry.repair import Repaired
from worker.geometry.texels import interpolate
from worker.pictures.camera import View, look_at
from worker.pictures.rasterising import Fragments, covered_pixels, doubled_areas, rasterise
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
    seen = interpolate(normals, np.arange(len(normals)), fragments.barycentrics)
    return _png(
        _averaged(shade(colours, seen, view.axes), fragments.places, side, max(side // size, 1)), size
    )


def _fitting_view(repaired: Repaired, side: int) -> tuple[View, int]:
    """Frame the mesh at the given size, or at half of it again and again while that is too much work."""
    view = look_at(repaired.vertices, side)
    while side > 32 and covered_pixels(view.pixels, repaired.faces, side) > MOST_PAIRS:
        side //= 2
        view = look_at(repaired.vertices, side)
    return view, side


def _surface_colours(mesh: Mesh, repaired: Repaired, view: View, fragments: Fragments) -> FloatArray:
    places = fragments.barycentrics.copy()
    turned = repaired.source_corners[fragments.faces, 1] == 2  # corners 0 2 1
    places[turned] = places[turned][:, [0, 2, 1]]
    shares = 2.0 / np.maximum(doubled_areas(view.pixels, repaired.faces, fragments.faces), 1e-12)
    footprints = np.minimum(shares, 1.0)  # one pixel's share of the face
    return look_up_colours(mesh, repaired.source_faces[fragments.faces], places, footprints)


@compiled
def _averaged(colours: FloatArray, places: IntArray, side: int, block: int) -> FloatArray:
    """Average blocks of pixels, covered ones only for the colour; (side / block, side / block, 4), 0…1."""
    picture = np.zeros((side // block, side // block, 4))
    for pixel in range(len(places)):
        row, column = places[pixel] // side // block, places[pixel] % side // block
        for channel in range(3):
            picture[row, column, channel] += colours[pixel, channel]
        picture[row, column, 3] += 1.0
    for row in range(side // block):
        for column in range(side // block):
            for channel in range(3):
                picture[row, column, channel] /= max(picture[row, column, 3], 1.0)
            picture[row, column, 3] /= block * block
    return picture


def _png(averages: FloatArray, size: int) -> bytes:
    pixels: ByteArray = np.rint(255 * averages).astype(np.uint8)
    picture = Image.fromarray(pixels, "RGBA")
    if len(pixels) != size:
        picture = picture.resize((size, size), Image.Resampling.BILINEAR)
    file = io.BytesIO()
    picture.save(file, "PNG")
    return file.getvalue()
