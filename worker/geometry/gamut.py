"""What sRGB can hold of colours in CIE Lab, fast and in single precision."""

import numpy as np

from worker.arrays import BoolArray, SingleArray

# Linear sRGB to XYZ (IEC 61966-2-1), each row divided by the white point's X, Y or Z.
_TO_XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
_TO_RELATIVE = (_TO_XYZ / _TO_XYZ.sum(axis=1, keepdims=True)).astype(np.float32)
_TO_LINEAR = np.linalg.inv(_TO_RELATIVE).astype(np.float32)
# Roots of relative X, Y and Z, less those of black, to Lab (CIE 15), and back.
_FROM_ROOTS = np.array([[0.0, 116.0, 0.0], [500.0, -500.0, 0.0], [0.0, 200.0, -200.0]], np.float32)
_TO_ROOTS = np.linalg.inv(_FROM_ROOTS).astype(np.float32)
_BLACK = 4.0 / 29.0  # what Lab takes for the cube root of 0
_BEND = 6.0 / 29.0  # root below which the cube is replaced by its tangent there
_SLOPE = 3.0 * _BEND**2  # of that tangent
_SLACK = 1e-3  # of linear sRGB, within which a colour counts as inside


def clip_to_gamut(lab: SingleArray) -> tuple[SingleArray, BoolArray]:
    """Clip colours channel by channel, as a file with 8 bits a channel does.

    Parameters
    ----------
    lab : (3, n) array
        CIE Lab under D65: a row of L, one of a, one of b.

    Returns
    -------
    clipped : (3, n) array
        Colours inside the gamut as they came.
    outside : (n,) array
        Which were not.
    """
    linear = _TO_LINEAR @ _relative(lab)
    outside = np.asarray(np.abs(linear - 0.5).max(axis=0) > 0.5 + _SLACK)
    if not outside.any():
        return lab, outside
    return np.where(outside, _lab(_TO_RELATIVE @ linear.clip(0.0, 1.0)), lab), outside


def _relative(lab: SingleArray) -> SingleArray:
    """Return XYZ relative to the white point (CIE 15); (3, n)."""
    roots = _TO_ROOTS @ lab + _BLACK
    above = np.maximum(roots, _BEND)
    return np.asarray(above * above * above + _SLOPE * (roots - above))


def _lab(relative: SingleArray) -> SingleArray:
    above = np.maximum(relative, _BEND**3)
    roots = np.cbrt(above) + (relative - above) / _SLOPE
    return np.asarray(_FROM_ROOTS @ (roots - _BLACK))
