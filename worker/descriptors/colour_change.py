"""Changes of light between two pictures of the same surface: affine in CIE Lab, then clipped."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from worker.arrays import SingleArray
from worker.geometry.gamut import clip_to_gamut

CONTRASTS = (0.15, 2.2)  # range of the factor on L
SATURATIONS = (0.03, 2.8)  # range of the factor on a and b
ROUNDS = 5  # of reweighting
FLOOR = 2.0  # Lab units; residuals below count alike
TRUST = 4.0  # squared Lab units; how firmly a factor stays at 1 where colours say nothing
CLIPPED = np.float32(0.1)  # weight of a colour that sRGB cannot hold

Channel = npt.NDArray[np.complexfloating]  # L, or a + ib: one formula fits both


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
        """Change colours (3, n), as a file would hold them."""
        return clip_to_gamut(self.unclipped(lab))[0]

    def unclipped(self, lab: SingleArray) -> SingleArray:
        """Change colours (3, n), whether sRGB can hold them or not."""
        factors = np.array([self.contrast, self.saturation, self.saturation], np.float32)
        shifts = np.array([self.offset, *self.tint], np.float32)
        return np.asarray(lab * factors[:, None] + shifts[:, None])


def fit_change(before: SingleArray, after: SingleArray, weights: SingleArray) -> ColourChange:
    """Find the change that takes colours to others, by least absolute deviations.

    Iteratively reweighted least squares (Huber 1981, section 7.8); colours that the change brings out of
    sRGB hardly count, since clipping hides where they went.

    Parameters
    ----------
    before, after : (3, n) arrays
        CIE Lab, column by column.
    weights : (n,) array
        Not negative.

    Returns
    -------
    ColourChange
    """
    light = _products(before[0], after[0])
    chroma = _products(before[1] + 1j * before[2], after[1] + 1j * after[2])
    change = _least_squares(light, chroma, weights, weights)
    for _ in range(ROUNDS - 1):
        in_light, in_chroma = _reweighted(change, before, after, weights)
        change = _least_squares(light, chroma, in_light, in_chroma)
    return change


def _reweighted(
    change: ColourChange, before: SingleArray, after: SingleArray, weights: SingleArray
) -> tuple[SingleArray, SingleArray]:
    """Return the weights (n,) by which squared residuals, in L and in (a, b), count as absolute ones."""
    clipped, outside = clip_to_gamut(change.unclipped(before))
    trusted = np.where(outside, CLIPPED * weights, weights)
    light, a, b = clipped - after
    return trusted / (np.abs(light) + FLOOR), trusted / (np.hypot(a, b) + FLOOR)


def _products(before: Channel, after: Channel) -> Channel:
    """Return the rows (5, n) whose weighted sums are all that `_affine` needs, in double precision."""
    x, y = before.astype(np.complex128), after.astype(np.complex128)
    return np.stack([np.ones_like(x), x, y, x.conj() * y, x.conj() * x])


def _least_squares(
    light: Channel, chroma: Channel, in_light: SingleArray, in_chroma: SingleArray
) -> ColourChange:
    """Fit products of L and of a + ib, each by weights (n,) of its own."""
    contrast, offset = _affine(light @ in_light, CONTRASTS)
    saturation, tint = _affine(chroma @ in_chroma, SATURATIONS)
    return ColourChange(
        contrast=contrast, offset=offset.real, saturation=saturation, tint=(tint.real, tint.imag)
    )


def _affine(sums: Channel, limits: tuple[float, float]) -> tuple[float, complex]:
    """Fit after = factor · before + shift, the factor real, to weighted sums (5,) of products."""
    total, *others = sums.tolist()
    x, y, overlap, power = [other / (total or 1.0) for other in others]
    covariance, variance = (overlap - x.conjugate() * y).real, (power - x.conjugate() * x).real
    factor = min(max((covariance + TRUST) / (variance + TRUST), limits[0]), limits[1])
    return factor, y - factor * x
