"""Changes of light between two pictures of the same surface: affine in CIE Lab, then clipped."""

from dataclasses import dataclass

import numpy as np

from worker.arrays import FloatArray, SingleArray
from worker.geometry.gamut import clip_to_gamut

CONTRASTS = (0.15, 2.2)  # range of the factor on L
SATURATIONS = (0.03, 2.8)  # range of the factor on a and b
ROUNDS = 5  # of reweighting
FLOOR = 2.0  # Lab units; residuals below count alike
TRUST = 4.0  # squared Lab units; how firmly a factor stays at 1 where colours say nothing
CLIPPED = np.float32(0.1)  # weight of a colour that sRGB cannot hold


@dataclass(frozen=True, kw_only=True)
class ColourChange:
    """L → contrast · L + offset, (a, b) → saturation · (a, b) + tint."""

    contrast: float = 1.0
    offset: float = 0.0  # Lab units
    saturation: float = 1.0
    tint: tuple[float, float] = (0.0, 0.0)  # Lab units

    def unusual(self) -> float:
        """Return how far from no change this is: 0 for none, about 1 for what light seldom does."""
        steps = abs(np.log(self.contrast)) + 0.6 * abs(np.log(self.saturation))
        return float(steps + abs(self.offset) / 40.0 + (abs(self.tint[0]) + abs(self.tint[1])) / 80.0)

    def apply(self, lab: SingleArray) -> SingleArray:
        """Change colours (n, 3), as a file would hold them."""
        return clip_to_gamut(self.unclipped(lab))[0]

    def unclipped(self, lab: SingleArray) -> SingleArray:
        """Change colours (n, 3), whether sRGB can hold them or not."""
        scales = np.array([self.contrast, self.saturation, self.saturation], np.float32)
        return np.asarray(lab * scales + np.array([self.offset, *self.tint], np.float32))


def fit_change(before: SingleArray, after: SingleArray, weights: SingleArray) -> ColourChange:
    """Find the change that takes colours to others, by least absolute deviations.

    Iteratively reweighted least squares (Huber 1981, section 7.8); colours that the change brings out of
    sRGB hardly count, since clipping hides where they went.

    Parameters
    ----------
    before, after : (n, 3) arrays
        CIE Lab, row by row.
    weights : (n,) array
        Not negative.

    Returns
    -------
    ColourChange
    """
    change, in_light, in_chroma = ColourChange(), weights, weights
    for _ in range(ROUNDS):
        change = _least_squares(before, after, in_light, in_chroma)
        found = change.unclipped(before)
        clipped, outside = clip_to_gamut(found)
        trusted = weights * np.where(outside, CLIPPED, np.float32(1.0))
        residuals = clipped - after
        in_light = trusted / (np.abs(residuals[:, 0]) + FLOOR)
        in_chroma = trusted / (np.sqrt((residuals[:, 1:] ** 2).sum(axis=1)) + FLOOR)
    return change


def _least_squares(
    before: SingleArray, after: SingleArray, in_light: SingleArray, in_chroma: SingleArray
) -> ColourChange:
    contrast, offset = _affine(before[:, :1], after[:, :1], in_light, CONTRASTS)
    saturation, tint = _affine(before[:, 1:], after[:, 1:], in_chroma, SATURATIONS)
    return ColourChange(
        contrast=contrast,
        offset=float(offset[0]),
        saturation=saturation,
        tint=(float(tint[0]), float(tint[1])),
    )


def _affine(
    before: SingleArray, after: SingleArray, weights: SingleArray, limits: tuple[float, float]
) -> tuple[float, FloatArray]:
    """Fit after = factor · before + shift, with one factor for all channels."""
    total = float(weights.sum()) or 1.0
    mean, target = weights @ before / total, weights @ after / total
    centred = before - mean
    overlap = float(weights @ (centred * (after - target)).sum(axis=1)) + TRUST * total
    power = float(weights @ (centred**2).sum(axis=1)) + TRUST * total
    factor = min(max(overlap / power, limits[0]), limits[1])
    return factor, np.asarray(target - factor * mean, np.float64)
