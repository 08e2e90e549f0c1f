"""From sRGB to CIE Lab.

The matrix and the curve of IEC 61966-2-1, Lab of CIE 15; the same numbers as colour-science gives.
"""

import numpy as np

from worker.arrays import FloatArray
from worker.compiled import compiled

D65 = (0.3127, 0.3290)  # chromaticity of the white point of sRGB and of our Lab
_TO_XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
_WHITE = np.array([D65[0] / D65[1], 1.0, (1.0 - D65[0] - D65[1]) / D65[1]])  # its XYZ
_TO_RELATIVE = _TO_XYZ / _WHITE[:, None]
_DARK = 12.92 * 0.0031308  # levels up to here are proportional to light
_BEND = (24.0 / 116.0) ** 3  # relative light up to here has a linear root


def srgb_to_lab(srgb: FloatArray) -> FloatArray:
    """Convert sRGB to CIE Lab.

    Parameters
    ----------
    srgb : (…, 3) array
        Encoded (non-linear) sRGB in 0…1.

    Returns
    -------
    (…, 3) array
        L in 0…100, a, b; white point D65 (IEC 61966-2-1, CIE 15).
    """
    flat = np.ascontiguousarray(srgb, dtype=np.float64).reshape(-1, 3)
    return _to_lab(flat, _BYTES).reshape(np.shape(srgb))


@compiled
def _to_lab(srgb: FloatArray, light_of_bytes: FloatArray) -> FloatArray:
    lab = np.empty_like(srgb)
    for point in range(len(srgb)):
        red = _light(srgb[point, 0], light_of_bytes)
        green = _light(srgb[point, 1], light_of_bytes)
        blue = _light(srgb[point, 2], light_of_bytes)
        x = _root(_TO_RELATIVE[0, 0] * red + _TO_RELATIVE[0, 1] * green + _TO_RELATIVE[0, 2] * blue)
        y = _root(_TO_RELATIVE[1, 0] * red + _TO_RELATIVE[1, 1] * green + _TO_RELATIVE[1, 2] * blue)
        z = _root(_TO_RELATIVE[2, 0] * red + _TO_RELATIVE[2, 1] * green + _TO_RELATIVE[2, 2] * blue)
        lab[point, 0] = 116.0 * y - 16.0
        lab[point, 1] = 500.0 * (x - y)
        lab[point, 2] = 200.0 * (y - z)
    return lab


@compiled
def _light(level: float, light_of_bytes: FloatArray) -> float:
    """Return the light of a level, looked up where the level is a byte's."""
    scaled = level * 255.0
    byte = int(scaled) if 0.0 <= scaled <= 255.0 else -1
    if byte == scaled:
        return float(light_of_bytes[byte])
    return float(_decoded(level))


@compiled
def _decoded(level: float) -> float:
    return level / 12.92 if level <= _DARK else ((level + 0.055) / 1.055) ** 2.4


@compiled
def _root(relative: float) -> float:
    return float(np.cbrt(relative)) if relative > _BEND else (841.0 / 108.0) * relative + 16.0 / 116.0


_BYTES = np.array([byte / 255.0 for byte in range(256)])
_BYTES = np.where(_BYTES <= _DARK, _BYTES / 12.92, ((_BYTES + 0.055) / 1.055) ** 2.4)
