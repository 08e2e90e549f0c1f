"""What sRGB can hold of colours in CIE Lab, fast and in single precision."""

import numpy as np

from worker.arrays import BoolArray, SingleArray
from worker.compiled import compiled

# Linear sRGB to XYZ (IEC 61966-2-1), each row divided by the white point's X, Y or Z.
_TO_XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
_TO_RELATIVE = (_TO_XYZ / _TO_XYZ.sum(axis=1, keepdims=True)).astype(np.float32)
_TO_LINEAR = np.linalg.inv(_TO_RELATIVE).astype(np.float32)
# Roots of relative X, Y and Z, less those of black, to Lab (CIE 15), and back.
_FROM_ROOTS = np.array([[0.0, 116.0, 0.0], [500.0, -500.0, 0.0], [0.0, 200.0, -200.0]], np.float32)
_TO_ROOTS = np.linalg.inv(_FROM_ROOTS).astype(np.float32)
_BLACK = np.float32(4.0 / 29.0)  # what Lab takes for the cube root of 0
_BEND = np.float32(6.0 / 29.0)  # root below which the cube is replaced by its tangent there
_CUBED = _BEND**3
_SLOPE = np.float32(3.0 * (6.0 / 29.0) ** 2)  # of that tangent
_NOTHING, _MIDDLE, _ALL = np.float32(0.0), np.float32(0.5), np.float32(1.0)  # of linear sRGB
_SLACK = np.float32(1e-3)  # of linear sRGB, within which a colour counts as inside


@compiled
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
    linear = _linear(lab)
    clipped, outside = lab.copy(), np.zeros(lab.shape[1], np.bool_)
    for i in range(lab.shape[1]):
        red, green, blue = linear[0, i], linear[1, i], linear[2, i]
        furthest = max(abs(red - _MIDDLE), abs(green - _MIDDLE), abs(blue - _MIDDLE))
        if furthest > _MIDDLE + _SLACK:
            outside[i] = True
            clipped[0, i], clipped[1, i], clipped[2, i] = _lab(_held(red), _held(green), _held(blue))
    return clipped, outside


@compiled
def _linear(lab: SingleArray) -> SingleArray:
    """Return linear sRGB (3, n)."""
    linear = np.empty_like(lab)
    for i in range(lab.shape[1]):
        x, y, z = _product(_TO_ROOTS, lab[0, i], lab[1, i], lab[2, i])
        x, y, z = _relative(x + _BLACK), _relative(y + _BLACK), _relative(z + _BLACK)
        linear[0, i], linear[1, i], linear[2, i] = _product(_TO_LINEAR, x, y, z)
    return linear


@compiled
def _relative(root: np.float32) -> np.float32:
    """Return X, Y or Z relative to the white point's (CIE 15)."""
    above = max(root, _BEND)
    return above * above * above + _SLOPE * (root - above)


@compiled
def _lab(red: np.float32, green: np.float32, blue: np.float32) -> tuple[np.float32, np.float32, np.float32]:
    x, y, z = _product(_TO_RELATIVE, red, green, blue)
    return _product(_FROM_ROOTS, _root(x) - _BLACK, _root(y) - _BLACK, _root(z) - _BLACK)


@compiled
def _root(relative: np.float32) -> np.float32:
    above = max(relative, _CUBED)
    return np.float32(np.cbrt(above) + (relative - above) / _SLOPE)


@compiled
def _held(channel: np.float32) -> np.float32:
    return min(max(channel, _NOTHING), _ALL)


@compiled
def _product(
    matrix: SingleArray, x: np.float32, y: np.float32, z: np.float32
) -> tuple[np.float32, np.float32, np.float32]:
    """Return a matrix (3, 3) times a vector."""
    return (
        matrix[0, 0] * x + matrix[0, 1] * y + matrix[0, 2] * z,
        matrix[1, 0] * x + matrix[1, 1] * y + matrix[1, 2] * z,
        matrix[2, 0] * x + matrix[2, 1] * y + matrix[2, 2] * z,
    )
