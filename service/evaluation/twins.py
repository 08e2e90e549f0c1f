"""Recoloured twins: the same surface in other colours, so that geometry alone cannot tell them apart."""

from dataclasses import replace

import numpy as np

from service.evaluation.protocol import random_of
from service.samples.colouring import PATTERNS, Coat, mix, rgb, step
from service.samples.palettes import random_coat
from worker.arrays import FloatArray
from worker.geometry.resampling import normalise_area
from worker.reading.mesh import Colour, Mesh

AREA = 3.0  # of the surface, where a coat's patterns have their size: that of the sample creatures


def make_twin(mesh: Mesh, model: str, number: int) -> Mesh:
    """Colour a mesh anew by a solid texture with a palette drawn for this twin.

    Parameters
    ----------
    mesh : Mesh
        Its own colours and images are replaced.
    model : str
        Name of the shape; with the number it decides the coat.
    number : int
        Of the twin.

    Returns
    -------
    Mesh
        With colours at its corners, in whole steps of 8 bits.
    """
    coat = random_coat(random_of(model, "twin", number))
    vertices = normalise_area(mesh.vertices, mesh.faces, AREA)
    colours = np.rint(255.0 * np.clip(_solid_colours(coat, vertices), 0.0, 1.0)) / 255.0
    return replace(
        mesh,
        corner_colours=colours[mesh.faces],
        corner_uvs=np.zeros((len(mesh.faces), 3, 2)),
        face_textures=np.full(len(mesh.faces), -1),
        textures=(),
        colour=Colour.VERTEX,
    )


def _solid_colours(coat: Coat, points: FloatArray) -> FloatArray:
    """Return sRGB (n, 3) at points: marks on a ground, lighter below and with another colour at the top."""
    marks = PATTERNS[coat.pattern](points / coat.scale, np.random.default_rng(coat.seed))
    ground = mix(np.broadcast_to(rgb(coat.base), points.shape), rgb(coat.mark), marks)
    heights = np.searchsorted(np.sort(points[:, 1]), points[:, 1]) / len(points)  # 0…1 from below
    ground = mix(ground, rgb(coat.belly), 0.7 * step(-heights, -0.2, 0.2))
    return mix(ground, rgb(coat.tip), 0.8 * step(heights, 0.9, 0.1))
