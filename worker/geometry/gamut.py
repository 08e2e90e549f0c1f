"""What sRGB can hold of colours in CIE Lab, fast and in single precision."""

import numpy as np

from worker.arrays import BoolArray, SingleArray

# Linear sRGB to XYZ (IEC 61966-2-1), each row divided by the white point's X, Y or Z.
_TO_XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
_TO_RELATIVE = (_TO_XYZ / _TO_XYZ.sum(axis=1, keepdims=True)).astype(np.float32)
_TO_LINEAR = np.linalg.inv(_TO_RELATIVE).astype(np.float32)
_BEND = 6.0 / 29.0  # where Lab's cube root becomes a straight line
_SLACK = 1e-3  # of linear sRGB, within which a colour counts as inside


def clip_to_gamut(lab: SingleArray) -> tuple[SingleArray, BoolArray]:
    """Clip colours channel by channel, as a file with 8 bits a channel does.

    Parameters
    ----------
    lab : (n, 3) array
        CIE Lab under D65.

    Returns
    -------
    clipped : (n, 3) array
        Colours inside the gamut as they came.
    outside : (n,) array
        Which were not.
    """
    linear = _relative(lab) @ _TO_LINEAR.T
    outside = np.asarray(((linear < -_SLACK) | (linear > 1.0 + _SLACK)).any(axis=1))
    if not outside.any():
        return lab, outside
    clipped = lab.copy()
    clipped[outside] = _lab(np.clip(linear[outside], 0.0, 1.0) @ _TO_RELATIVE.T)
    return clipped, outside


def _relative(lab: SingleArray) -> SingleArray:
    """Return XYZ relative to the white point (CIE 15)."""
    middle = (lab[:, 0] + np.float32(16.0)) / np.float32(116.0)
    roots = np.stack([middle + lab[:, 1] / 500, middle, middle - lab[:, 2] / 200], axis=1)
    return np.where(roots > _BEND, roots**3, (roots - 4.0 / 29.0) * (3.0 * _BEND**2)).astype(np.float32)


def _lab(relative: SingleArray) -> SingleArray:
    roots = np.where(relative > _BEND**3, np.cbrt(relative), relative / (3.0 * _BEND**2) + 4.0 / 29.0)
    x, y, z = roots.T
    return np.stack([116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)], axis=1).astype(np.float32)
