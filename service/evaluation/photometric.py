"""Changes of light and colour, in CIE Lab, at five strengths; what sRGB cannot hold is clipped."""

import warnings
from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from worker.arrays import ByteArray, FloatArray
from worker.geometry.colour import D65, look_up_colours, srgb_to_lab
from worker.geometry.resampling import sample_surface
from worker.reading.mesh import Mesh

with warnings.catch_warnings():  # colour warns that its plots need matplotlib; nothing is plotted here
    warnings.simplefilter("ignore")
    import colour

SAMPLES = 20_000  # points from which a mesh's mean lightness is taken

Change = Callable[[FloatArray, float, int], FloatArray]  # Lab (n, 3), mean L, strength → Lab (n, 3)


def _scaled(lab: FloatArray, lightness: float, chroma: float, mean: float) -> FloatArray:
    """Scale L about a mean, and a and b about grey."""
    return np.asarray((lab - [mean, 0.0, 0.0]) * [lightness, chroma, chroma] + [mean, 0.0, 0.0])


CHANGES: Mapping[str, Change] = {
    "contrast+": lambda lab, mean, strength: _scaled(lab, 1.0 + 0.16 * strength, 1.0, mean),
    "contrast-": lambda lab, mean, strength: _scaled(lab, 1.0 - 0.16 * strength, 1.0, mean),
    "brightness+": lambda lab, _, strength: lab + [8.0 * strength, 0.0, 0.0],
    "brightness-": lambda lab, _, strength: lab - [8.0 * strength, 0.0, 0.0],
    "hue": lambda lab, _, strength: lab + [0.0, 12.0 * strength, 0.0],
    "saturation+": lambda lab, mean, strength: _scaled(lab, 1.0, 1.0 + 0.3 * strength, mean),
    "saturation-": lambda lab, mean, strength: _scaled(lab, 1.0, 1.0 - 0.19 * strength, mean),
}
NOISE = "noise"
DEVIATION = 4.0  # σ of the noise for each step of strength, Lab units in every channel
PHOTOMETRIC = (*CHANGES, NOISE)


def recolour(mesh: Mesh, change: str, strength: int, random: np.random.Generator) -> Mesh:
    """Change all colours of a mesh: those at corners and those of its images.

    Parameters
    ----------
    mesh : Mesh
    change : str
        One of PHOTOMETRIC.
    strength : int
        1…5.
    random : numpy Generator
        Of the noise: a draw for each vertex and for each texel.

    Returns
    -------
    Mesh
        Colours in whole steps of 8 bits, as a file would hold them.
    """
    mean = mean_lightness(mesh) if change.startswith("contrast") else 0.0

    def changed(srgb: FloatArray, noise: FloatArray) -> FloatArray:
        lab = srgb_to_lab(srgb)
        if change == NOISE:
            return lab_to_srgb(lab + DEVIATION * strength * noise)
        return lab_to_srgb(CHANGES[change](lab, mean, strength))

    at_vertices = random.standard_normal((len(mesh.vertices), 3))
    corners = changed(mesh.corner_colours.reshape(-1, 3), at_vertices[mesh.faces.ravel()])
    images = []
    for texture in mesh.textures:
        colours = texture.reshape(-1, 3) / 255.0
        texels = changed(colours, random.standard_normal(colours.shape))
        images.append(_bytes(texels).reshape(texture.shape))
    rounded = _bytes(corners).reshape(-1, 3, 3) / 255.0
    return replace(mesh, corner_colours=rounded, textures=tuple(images))


def lab_to_srgb(lab: FloatArray) -> FloatArray:
    """Convert CIE Lab (n, 3) under D65 to sRGB in 0…1; colours outside are clipped, channel by channel."""
    return np.asarray(np.clip(colour.XYZ_to_sRGB(colour.Lab_to_XYZ(lab, np.array(D65))), 0.0, 1.0))


def mean_lightness(mesh: Mesh) -> float:
    """Return the mean of L over the surface of a mesh."""
    faces, places = sample_surface(mesh.vertices, mesh.faces, SAMPLES)
    return float(srgb_to_lab(look_up_colours(mesh, faces, places))[:, 0].mean())


def _bytes(srgb: FloatArray) -> ByteArray:
    return np.rint(255.0 * srgb).astype(np.uint8)
