"""Where a picture is taken from: three quarters from the front, a little above, y upwards."""

from dataclasses import dataclass

import numpy as np

from worker.arrays import FloatArray

AZIMUTH = 35.0  # degrees from +z towards +x
ELEVATION = 20.0  # degrees above the horizon
MARGIN = 1.06  # the frame's side over the larger side of what is seen


@dataclass(frozen=True, kw_only=True, eq=False)
class View:
    """Points as the camera sees them, orthographically."""

    pixels: FloatArray  # (n, 2), column to the right and row downwards, in pixels
    depths: FloatArray  # (n,), away from the camera, in pixels
    axes: FloatArray  # (3, 3), rows: right, up, towards the camera


def camera_axes() -> FloatArray:
    """Return orthonormal rows: right, up, towards the camera."""
    azimuth, elevation = np.radians([AZIMUTH, ELEVATION])
    back = np.array(
        [np.sin(azimuth) * np.cos(elevation), np.sin(elevation), np.cos(azimuth) * np.cos(elevation)]
    )
    right = np.array([np.cos(azimuth), 0.0, -np.sin(azimuth)])
    return np.stack([right, np.cross(back, right), back])


def look_at(points: FloatArray, size: int) -> View:
    """Frame all points in a square picture.

    Parameters
    ----------
    points : (n, 3) array
        In any unit, however far from the origin.
    size : int
        The picture's side in pixels.

    Returns
    -------
    View
    """
    axes = camera_axes()
    seen = (points - (points.min(0) + points.max(0)) / 2) @ axes.T  # (n, 3)
    lower, upper = seen.min(0), seen.max(0)
    extent = float((upper - lower)[:2].max()) or 1.0  # a needle that points at the camera has none
    scale = size / (MARGIN * extent)
    middle = (lower + upper) / 2
    right, up, towards = ((seen - middle) * scale).T
    return View(pixels=np.stack([size / 2 + right, size / 2 - up], axis=1), depths=-towards, axes=axes)
