"""Landmarks: a few points of a surface, each with how heat leaves it and what colour it has."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from worker.arrays import BoolArray, FloatArray, IntArray, SingleArray

RUNGS = 4  # of the ladder of times to an octave
SHORTER, LONGER = 1, 2  # rungs by which all times may be shifted down and up
OCTAVES = 7  # times of a signature: one an octave
FIRST = 64.0  # the shortest of them, squared units
LADDER = tuple(
    FIRST * 2.0 ** (rung / RUNGS) for rung in range(-SHORTER, RUNGS * (OCTAVES - 1) + LONGER + 1)
)  # squared units
SPREADS = np.array([0.14, 0.17, 0.17, 0.13, 0.16, 0.23], np.float32)  # usual deviations of the rates
WIDTH = len(SPREADS) + 4  # numbers of a landmark as stored: rates, Lab, share


@dataclass(frozen=True, kw_only=True, eq=False)
class Landmarks:
    """Points that stand for a surface: a column for each."""

    rates: SingleArray  # (6, p), log-HKS differences from octave to octave, in usual deviations
    lab: SingleArray  # (3, p), mean colour of each point's cell
    shares: SingleArray  # (p,), of the area, positive; they sum to 1


def log_heat_ladder(log_signatures: FloatArray, n_points: int) -> FloatArray:
    """Fill the ladder (p, j) of few points up to a fixed number, by zeros; (n_points, j)."""
    ladder = np.zeros((n_points, len(LADDER)))
    ladder[: len(log_signatures)] = log_signatures
    return ladder


def place_landmarks(
    vertices: FloatArray, points: IntArray, areas: FloatArray, lab: FloatArray, n_points: int
) -> FloatArray:
    """Return colour and share of each landmark.

    Parameters
    ----------
    vertices, lab : (n, 3) arrays
    points : (p,) array
        Indices of vertices: farthest points.
    areas : (n,) array
    n_points : int
        Rows of the result, p or more.

    Returns
    -------
    (n_points, 4) array
        Area-weighted mean Lab of the vertices nearest to each point, and their share of the area; zeros
        where a small mesh has fewer points.
    """
    nearest = cKDTree(vertices[points]).query(vertices)[1]
    sums = np.bincount(nearest, areas, n_points)
    colours = [np.bincount(nearest, areas * channel, n_points) for channel in lab.T]
    return np.column_stack([*(colours / np.maximum(sums, np.finfo(float).tiny)), sums / areas.sum()])


def rates_at(ladder: FloatArray | SingleArray, shift: int) -> SingleArray:
    """Return log h at each octave less log h an octave before, in usual deviations.

    Parameters
    ----------
    ladder : (p, j) array
        log h_t at the times of LADDER.
    shift : int
        Rungs by which all times are shifted, from −SHORTER to LONGER: as if the area were 2^(−shift/RUNGS)
        of what it is.

    Returns
    -------
    (p, 6) array
    """
    octaves = SHORTER + shift + RUNGS * np.arange(OCTAVES)
    return np.asarray(np.diff(ladder[:, octaves], axis=1) / SPREADS, np.float32)


def pack(ladder: FloatArray, placed: FloatArray) -> FloatArray:
    """Return what is stored of the landmarks of a shape; (p, WIDTH)."""
    return np.hstack([rates_at(ladder, 0), placed]).astype(np.float64)


def unpack(packed: SingleArray) -> Landmarks:
    """Return landmarks from what `pack` gave, in one piece or as a flat vector, but those without area."""
    columns = np.ascontiguousarray(packed.reshape(-1, WIDTH)[present(packed)].T)
    n_rates = len(SPREADS)
    return Landmarks(rates=columns[:n_rates], lab=columns[n_rates : n_rates + 3], shares=columns[-1])


def present(packed: SingleArray) -> BoolArray:
    """Return which rows (p,) of what `pack` gave stand for some area."""
    return np.asarray(packed.reshape(-1, WIDTH)[:, -1] > 0)
