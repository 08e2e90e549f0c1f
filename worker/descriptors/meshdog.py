"""MeshDOG: where on a surface a function has a blob or a corner.

Zaharescu, Boyer, Varanasi and Horaud (2009), "Surface Feature Detection and Description with Applications to
Mesh Matching", section 3.
"""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from worker.arrays import BoolArray, FloatArray, IntArray
from worker.geometry.areas import vertex_normals
from worker.geometry.gradients import gradient_operator, tangent_hessians
from worker.geometry.rings import one_rings

OCTAVES = 3
STEPS = 6  # levels of an octave, the last three of which begin the next; σ grows by 2^(1/3)
WIDTH = 0.5  # σ of one average over the 1-ring, in mean edges
FIRST = 2  # averages that make the first level
STRONGEST = 0.05  # share of the vertices that may be features
RATIO = 10.0  # of the Hessian's eigenvalues, above which an extremum is an edge
FEWEST, MOST = 100, 2_000  # features of a shape, where it has as many extrema
ROUNDING = 1e-6  # smaller differences are none; in units of CIE Lab


@dataclass(frozen=True, kw_only=True, eq=False)
class Terrain:
    """A surface with what detector and descriptor both ask of it."""

    vertices: FloatArray  # (n, 3)
    faces: IntArray  # (m, 3)
    normals: FloatArray  # (n, 3), unit ones
    rings: csr_array  # (n, n), as from `one_rings`
    operator: csr_array  # (3 n, n), as from `gradient_operator`


def terrain_of(vertices: FloatArray, faces: IntArray) -> Terrain:
    """Prepare a surface."""
    return Terrain(
        vertices=vertices,
        faces=faces,
        normals=vertex_normals(vertices, faces),
        rings=one_rings(faces, len(vertices)),
        operator=gradient_operator(vertices, faces),
    )


def meshdog(scalar: FloatArray, vertices: FloatArray, faces: IntArray) -> IntArray:
    """Detect the features of a function on a surface.

    Of the extrema of the differences of Gaussians over the 1-ring and both neighbouring differences, keep the
    strongest, 5 % of the vertices at most; of those, the ones whose Hessian has eigenvalues of one sign and a
    ratio below 10. Where fewer than 100 remain, the strongest of the other extrema fill up.

    Parameters
    ----------
    scalar : (n,) array
        L of CIE Lab, say: differences below 1e-6 are taken for rounding.
    vertices : (n, 3) array
    faces : (m, 3) array

    Returns
    -------
    (f,) array
        Indices of vertices: those that passed, the strongest first, then the others. Empty where the function
        is constant.
    """
    extrema, n_passed = ranked_extrema(scalar, terrain_of(vertices, faces))
    return extrema[: n_kept(n_passed)]


def n_kept(n_passed: int) -> int:
    """Return how many of the ranked extrema are features, where so many passed the tests."""
    return min(max(n_passed, FEWEST), MOST)


def ranked_extrema(scalar: FloatArray, terrain: Terrain) -> tuple[IntArray, int]:
    """Find all extrema and rank them. The function as for `meshdog`.

    Returns
    -------
    extrema : (e,) array
        Indices of vertices: those that passed the tests, the strongest first, then the others.
    n_passed : int
    """
    differences = differences_of_gaussians(scalar, terrain.vertices, terrain.rings)
    strengths = _extrema(differences, terrain.rings) * np.abs(differences[1:-1])  # (levels − 2, n)
    strongest = strengths.max(axis=0)
    found = np.flatnonzero(strongest > ROUNDING)
    found = found[np.argsort(-strongest[found], kind="stable")]
    levels = 1 + strengths.argmax(axis=0)[found]
    passed = are_corners(_hessians(differences, levels, found, terrain))
    passed[int(np.ceil(STRONGEST * len(scalar))) :] = False
    return found[np.argsort(~passed, kind="stable")], int(passed.sum())


def differences_of_gaussians(scalar: FloatArray, vertices: FloatArray, rings: csr_array) -> FloatArray:
    """Blur a function step by step and subtract neighbouring steps.

    A level is reached by repeated Gaussian averages over the 1-ring. As variances add, their number grows by
    4^(1/3) from level to level: 2, 3, 5, 8, 13, 20 … 323. One average more on each level would not do: the
    differences would only fade, and none would be beyond both its neighbours.

    Parameters
    ----------
    scalar : (n,) array
    vertices : (n, 3) array
    rings : (n, n) matrix
        From `one_rings`.

    Returns
    -------
    (levels − 1, n) array
        The more blurred less the less blurred.
    """
    average = _average(vertices, rings)
    n_levels = 3 * (OCTAVES - 1) + STEPS
    averages = np.round(FIRST * 4.0 ** (np.arange(n_levels) / 3.0)).astype(np.int64)
    blurred, levels = scalar - scalar.mean(), []  # differences of large numbers lose digits
    for more in np.diff(averages, prepend=0):
        for _ in range(more):
            blurred = average @ blurred
        levels.append(blurred)
    return np.diff(np.stack(levels), axis=0)


def _average(vertices: FloatArray, rings: csr_array) -> csr_array:
    """Weigh each vertex's 1-ring by a Gaussian of the distance; rows sum to 1."""
    rows = np.repeat(np.arange(len(vertices)), np.diff(rings.indptr))
    squares = np.sum((vertices[rings.indices] - vertices[rows]) ** 2, axis=1)
    sigma = WIDTH * np.sqrt(squares[squares > 0]).mean()
    weights = np.exp(-squares / (2.0 * sigma**2))
    weights /= np.bincount(rows, weights)[rows]
    return csr_array((weights, rings.indices, rings.indptr), shape=rings.shape)


def _extrema(differences: FloatArray, rings: csr_array) -> BoolArray:
    """Tell where no neighbour in space or scale is beyond a vertex, on its own side of 0; (levels − 2, n)."""
    around = differences[:, rings.indices]  # each 1-ring, one after the other
    highest = np.maximum.reduceat(around, rings.indptr[:-1], axis=1)
    lowest = np.minimum.reduceat(around, rings.indptr[:-1], axis=1)
    highest = np.maximum(np.maximum(highest[:-2], highest[1:-1]), highest[2:])
    lowest = np.minimum(np.minimum(lowest[:-2], lowest[1:-1]), lowest[2:])
    inner = differences[1:-1]
    return np.asarray(np.where(inner > 0, inner >= highest, inner <= lowest))


def _hessians(differences: FloatArray, levels: IntArray, found: IntArray, terrain: Terrain) -> FloatArray:
    """Return the Hessian at each extremum on its own level; (f, 2, 2)."""
    hessians = np.empty((len(found), 2, 2))
    for level in np.unique(levels):
        there = levels == level
        hessians[there] = tangent_hessians(
            terrain.operator, differences[level], terrain.normals, found[there]
        )
    return hessians


def are_corners(hessians: FloatArray) -> BoolArray:
    """Tell where both eigenvalues (f, 2, 2) have one sign and a ratio below 10; (f,).

    By trace² / determinant < (10 + 1)² / 10: Lowe (2004), "Distinctive Image Features from Scale-Invariant
    Keypoints", section 4.1.
    """
    traces, determinants = np.trace(hessians, axis1=1, axis2=2), np.linalg.det(hessians)
    return np.asarray((determinants > 0) & (RATIO * traces**2 < (RATIO + 1.0) ** 2 * determinants))
