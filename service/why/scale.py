"""The scale of an explanation: which density of contribution has the strongest colour, and the colours."""

import numpy as np

from index.methods import Method
from worker.arrays import FloatArray

STRONGEST = 0.5  # share of what is placed that has the strongest colour
FAINT = 0.25  # of the usual distances between unrelated shapes: what is less never has the strongest colour
USUAL = {
    "log-hks": 0.587,
    "colour-histogram": 1.83,
    "colour-curves": 150.5,
    "hks-0": 0.4,
    "hks-0.05": 0.5,
    "hks-0.1": 0.5,
}  # L1 distance of each block between unrelated shapes, on average
COLOURS = ("#e9ebee", "#ffd24d", "#f27d2f", "#9e1030")  # from nothing to the most, at equal steps
_STOPS = np.array([[int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)] for colour in COLOURS])  # (4, 3)


def scale_of(densities: FloatArray, shares: FloatArray, method: Method) -> float:
    """Return the density that the strongest colour shows.

    Half of what is placed lies where the density is at least this: so a region is red that holds most of the
    difference, be it large or small, and single points decide nothing. But never less than a part of what is
    usual between unrelated shapes, or the last digits of two equal shapes would look like a difference.

    Parameters
    ----------
    densities : (n,) array
        Of contribution, on both surfaces.
    shares : (n,) array
        Of the area.
    method : Method
        With the weights that count.
    """
    order = np.argsort(densities, kind="stable")
    summed = np.cumsum((densities * shares)[order])
    middle = densities[order][np.searchsorted(summed, (1.0 - STRONGEST) * summed[-1])]
    return max(float(middle), faint_density(method))


def faint_density(method: Method) -> float:
    """Return the mean density, over two surfaces, of a distance that is a part of the usual ones."""
    counted = [block for block in method.blocks if block.weight]
    return sum(block.weight * (FAINT * USUAL[block.name]) ** block.power for block in counted) / 2.0


def colours_of(densities: FloatArray, scale: float) -> FloatArray:
    """Return sRGB (n, 3), 0…1, of densities (n,), mixed in sRGB."""
    places = np.clip(densities / scale, 0.0, 1.0) * (len(_STOPS) - 1)
    return np.stack([np.interp(places, range(len(_STOPS)), column) for column in _STOPS.T], axis=1)
