"""Changes of light between two pictures of the same surface: affine in CIE Lab, then clipped."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from worker.arrays import FloatArray, SingleArray
from worker.compiled import compiled
from worker.geometry.gamut import clip_to_gamut

CONTRASTS = (0.15, 2.2)  # range of the factor on L
SATURATIONS = (0.03, 2.8)  # range of the factor on a and b
ROUNDS = 5  # of reweighting
FLOOR = np.float32(2.0)  # Lab units; residuals below count alike
TRUST = 4.0  # squared Lab units; how firmly a factor stays at 1 where colours say nothing
CLIPPED = np.float32(0.1)  # weight of a colour that sRGB cannot hold


@dataclass(frozen=True, kw_only=True)
class ColourChange:
    """L → contrast · L + offset, (a, b) → saturation · (a, b) + tint."""

    contrast: float = 1.0
    offset: float = 0.0  # Lab units
    saturation: float = 1.0
    tint: tuple[float, float] = (0.0, 0.0)  # Lab units

    @classmethod
    def of(cls, numbers: Sequence[float]) -> "ColourChange":
        """Return the change that `fit_light` found."""
        contrast, offset, saturation, green, blue = numbers
        return cls(contrast=contrast, offset=offset, saturation=saturation, tint=(green, blue))

    def unusual(self) -> float:
        """Return how far from no change this is: 0 for none, about 1 for what light seldom does."""
        steps = abs(np.log(self.contrast)) + 0.6 * abs(np.log(self.saturation))
        return float(steps + abs(self.offset) / 40.0 + (abs(self.tint[0]) + abs(self.tint[1])) / 80.0)

    def apply(self, lab: SingleArray) -> SingleArray:
        """Change colours (3, n), as a file would hold them."""
        return clip_to_gamut(self.unclipped(lab))[0]

    def unclipped(self, lab: SingleArray) -> SingleArray:
        """Change colours (3, n), whether sRGB can hold them or not."""
        numbers = np.array([self.contrast, self.offset, self.saturation, *self.tint])
        return relit(np.ascontiguousarray(lab), numbers)


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
    pairs = np.ascontiguousarray(before), np.ascontiguousarray(after)
    return ColourChange.of(fit_light(*pairs, weights, TRUST, CLIPPED, ROUNDS).tolist())


@compiled
def fit_light(
    before: SingleArray,
    after: SingleArray,
    weights: SingleArray,
    trust: float = TRUST,
    doubt: np.float32 = CLIPPED,
    rounds: int = ROUNDS,
) -> FloatArray:
    """Do what `fit_change` says; return contrast, offset, saturation and tint, (5,)."""
    change = _least_squares(before, after, weights, weights, trust)
    for _ in range(rounds - 1):
        clipped, outside = clip_to_gamut(relit(before, change))
        in_light, in_chroma = weights.copy(), weights.copy()  # by which squared residuals count as absolute
        for i in range(len(weights)):
            trusted = doubt * weights[i] if outside[i] else weights[i]
            light, a, b = (
                clipped[0, i] - after[0, i],
                clipped[1, i] - after[1, i],
                clipped[2, i] - after[2, i],
            )
            in_light[i] = trusted / (abs(light) + FLOOR)
            in_chroma[i] = trusted / (np.sqrt(a * a + b * b) + FLOOR)
        change = _least_squares(before, after, in_light, in_chroma, trust)
    return change


@compiled
def relit(lab: SingleArray, change: FloatArray) -> SingleArray:
    """Return colours (3, n) changed, whether sRGB can hold them or not."""
    contrast, offset, saturation = np.float32(change[0]), np.float32(change[1]), np.float32(change[2])
    green, blue = np.float32(change[3]), np.float32(change[4])
    changed = np.empty_like(lab)
    for i in range(lab.shape[1]):
        changed[0, i] = lab[0, i] * contrast + offset
        changed[1, i] = lab[1, i] * saturation + green
        changed[2, i] = lab[2, i] * saturation + blue
    return changed


@compiled
def _least_squares(
    before: SingleArray, after: SingleArray, in_light: SingleArray, in_chroma: SingleArray, trust: float
) -> FloatArray:
    """Fit L and (a, b), each by weights (n,) of its own."""
    change = np.empty(5)
    change[0] = _affine(before[:1], after[:1], in_light, CONTRASTS, trust, change[1:2])
    change[2] = _affine(before[1:], after[1:], in_chroma, SATURATIONS, trust, change[3:])
    return change


@compiled
def _affine(
    before: SingleArray,
    after: SingleArray,
    weights: SingleArray,
    limits: tuple[float, float],
    trust: float,
    shifts: FloatArray,
) -> float:
    """Fit after = factor · before + shift to channels (c, n) with one factor; fill in the shifts (c,)."""
    means = np.empty(len(before))
    covariance, variance = 0.0, 0.0
    for k in range(len(before)):
        means[k], shifts[k], overlap, power = _moments(before[k], after[k], weights)
        covariance += overlap - means[k] * shifts[k]
        variance += power - means[k] * means[k]
    factor = min(max((covariance + trust) / (variance + trust), limits[0]), limits[1])
    for k in range(len(before)):
        shifts[k] -= factor * means[k]
    return factor


@compiled
def _moments(x: SingleArray, y: SingleArray, weights: SingleArray) -> tuple[float, float, float, float]:
    """Return the weighted means of x, y, xy and x²; zeros where nothing has weight."""
    total, sum_x, sum_y, overlap, power = 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(len(weights)):
        weight, from_x, to_y = np.float64(weights[i]), np.float64(x[i]), np.float64(y[i])
        total += weight
        sum_x += weight * from_x
        sum_y += weight * to_y
        overlap += weight * from_x * to_y
        power += weight * from_x * from_x
    whole = total if total > 0.0 else 1.0
    return sum_x / whole, sum_y / whole, overlap / whole, power / whole
