"""MeshHOG: histograms of a function's gradients around points of a surface.

Zaharescu, Boyer, Varanasi and Horaud (2009), "Surface Feature Detection and Description with Applications to
Mesh Matching", section 4.
"""

from dataclasses import dataclass

import numpy as np

from worker.arrays import FloatArray, IntArray
from worker.descriptors.meshdog import ROUNDING, Terrain, n_kept, ranked_extrema, terrain_of
from worker.geometry.areas import edge_lengths, triangle_areas, unit, vertex_areas
from worker.geometry.gradients import gradients, tangent_bases
from worker.geometry.rings import rings_covering

SUPPORT = 0.01  # of the surface's area
DIRECTIONS = 36  # bins of the histogram whose peak is the tangent axis
SMOOTHINGS = 6  # of that histogram, by means of three bins, as implementations of SIFT do
SLICES = 4  # of each plane, by the angle of the position; the first lies around the first axis
ORIENTATIONS = 8  # bins of the gradient's angle
PLANES = ((0, 1), (1, 2), (2, 0))  # of the axes tangent, normal × tangent, normal


@dataclass(frozen=True, kw_only=True, eq=False)
class Supports:
    """Pairs of a feature and a vertex near it."""

    owners: IntArray  # (p,), which feature
    offsets: FloatArray  # (p, 3), from the feature to the vertex
    gradients: FloatArray  # (p, 3), at the vertex, weighted by a Gaussian of the distance


def mesh_features(scalar: FloatArray, vertices: FloatArray, faces: IntArray) -> FloatArray:
    """Describe the features that `meshdog` detects.

    Parameters
    ----------
    scalar : (n,) array
    vertices : (n, 3) array
    faces : (m, 3) array

    Returns
    -------
    (f, 96) array
        Rows of length 1. Extrema without contrast in their support, which lie in large patches of one colour,
        are left out; the next ones take their place. No rows at all where the function is constant.
    """
    terrain = terrain_of(vertices, faces)
    extrema, n_passed = ranked_extrema(scalar, terrain)
    descriptors = describe_points(scalar, terrain, extrema)
    described = np.asarray(descriptors.any(axis=1))
    return descriptors[described][: n_kept(int(described[:n_passed].sum()))]


def meshhog(scalar: FloatArray, vertices: FloatArray, faces: IntArray, indices: IntArray) -> FloatArray:
    """Describe a function around vertices.

    Parameters
    ----------
    scalar : (n,) array
    vertices : (n, 3) array
    faces : (m, 3) array
        Turned alike: the other way round gives another descriptor.
    indices : (f,) array
        Vertices to describe.

    Returns
    -------
    (f, 96) array
        Plane slowest, then slice, then orientation; not negative, of length 1, or 0 where the support has one
        colour.
    """
    return describe_points(scalar, terrain_of(vertices, faces), indices)


def describe_points(scalar: FloatArray, terrain: Terrain, indices: IntArray) -> FloatArray:
    """Describe a function (n,) around vertices (f,), as `meshhog` does; (f, 96)."""
    normals = terrain.normals[indices]
    supports = _supports(scalar, terrain, indices)
    frames = _frames(supports, normals)  # (f, 3, 3)
    places = np.einsum("pac,pc->pa", frames[supports.owners], unit(supports.offsets))
    slopes = np.einsum("pac,pc->pa", frames[supports.owners], supports.gradients)
    histograms = [
        _histograms(supports.owners, places[:, plane], slopes[:, plane], len(indices)) for plane in PLANES
    ]
    return unit(np.hstack(histograms))


def _supports(scalar: FloatArray, terrain: Terrain, indices: IntArray) -> Supports:
    """Take the rings that cover 1 % of the surface; σ is the radius of a flat disc of that area."""
    vertices, faces = terrain.vertices, terrain.faces
    areas = vertex_areas(faces, triangle_areas(edge_lengths(vertices, faces)), len(vertices))
    area = SUPPORT * float(areas.sum())
    owners, members = rings_covering(terrain.rings, areas, indices, area)
    slopes = gradients(terrain.operator, scalar)[members]
    offsets = vertices[members] - vertices[indices[owners]]
    weights = np.exp(-np.sum(offsets**2, axis=1) * np.pi / (2.0 * area))
    steep = np.linalg.norm(slopes, axis=1) * np.sqrt(area / np.pi) > ROUNDING
    return Supports(owners=owners, offsets=offsets, gradients=slopes * (weights * steep)[:, None])


def _frames(supports: Supports, normals: FloatArray) -> FloatArray:
    """Return the local axes of each feature: tangent, normal × tangent, normal; (f, 3, 3).

    The tangent is the peak of a histogram of gradient directions. Its first bin lies around the mean
    gradient, so that it turns with the surface.
    """
    n_features, owners = len(normals), supports.owners
    sums = [np.bincount(owners, column, n_features) for column in supports.gradients.T]
    mean = _across(np.stack(sums, axis=1), normals)
    first = np.where(mean.any(axis=1, keepdims=True), unit(mean), tangent_bases(normals)[:, 0])
    second = np.cross(normals, first)
    slopes = np.einsum("pac,pc->pa", np.stack([first, second], axis=1)[owners], supports.gradients)
    angles = _peaks(_directions(owners, slopes, n_features))[:, None]
    tangents = np.cos(angles) * first + np.sin(angles) * second
    return np.stack([tangents, np.cross(normals, tangents), normals], axis=1)


def _across(vectors: FloatArray, normals: FloatArray) -> FloatArray:
    """Project vectors on the planes across unit normals; (n, 3)."""
    return np.asarray(vectors - np.sum(vectors * normals, axis=1, keepdims=True) * normals)


def _directions(owners: IntArray, slopes: FloatArray, n_features: int) -> FloatArray:
    """Sum the lengths of gradients (p, 2) by their angle; (f, DIRECTIONS)."""
    bins, shares = _nearest_bins(slopes, DIRECTIONS)
    votes = np.hypot(slopes[:, 0], slopes[:, 1])[:, None] * shares
    cells = owners[:, None] * DIRECTIONS + bins
    sums = np.bincount(cells.ravel(), votes.ravel(), n_features * DIRECTIONS)
    return np.asarray(sums, np.float64).reshape(-1, DIRECTIONS)


def _peaks(votes: FloatArray) -> FloatArray:
    """Return the angle of the highest point of each circular histogram, between bins by a parabola; (f,)."""
    for _ in range(SMOOTHINGS):
        votes = (np.roll(votes, 1, axis=1) + votes + np.roll(votes, -1, axis=1)) / 3.0
    peak = votes.argmax(axis=1)
    before, at, after = (votes[np.arange(len(votes)), (peak + k) % DIRECTIONS] for k in (-1, 0, 1))
    bend = 2.0 * at - before - after
    places = peak + (after - before) / (2.0 * np.where(bend > 0, bend, 1.0))
    return np.asarray(places * 2.0 * np.pi / DIRECTIONS)


def _histograms(owners: IntArray, places: FloatArray, slopes: FloatArray, n_features: int) -> FloatArray:
    """Sum the lengths of gradients (p, 2) by their angles and those of the places (p, 2); (f, 32).

    A place steeply above the plane has no certain angle there: it counts by its length in the plane.
    """
    slices, slice_shares = _nearest_bins(places, SLICES)
    orientations, orientation_shares = _nearest_bins(slopes, ORIENTATIONS)
    slices += owners[:, None] * SLICES
    cells = slices[:, :, None] * ORIENTATIONS + orientations[:, None]  # (p, 2, 2)
    lengths = np.hypot(*slopes.T) * np.hypot(*places.T)  # (p,)
    votes = lengths[:, None, None] * slice_shares[:, :, None] * orientation_shares[:, None]
    length = SLICES * ORIENTATIONS
    sums = np.bincount(cells.ravel(), votes.ravel(), n_features * length)
    return np.asarray(sums, np.float64).reshape(-1, length)


def _nearest_bins(vectors: FloatArray, n_bins: int) -> tuple[IntArray, FloatArray]:
    """Share vectors (p, 2) by their angle among the two nearest bins of a circle; bins and shares, (p, 2)."""
    angles = np.arctan2(vectors[:, 1], vectors[:, 0]) * n_bins / (2.0 * np.pi)  # in bins
    lower = np.floor(angles)
    upper_shares = angles - lower
    bins = (lower.astype(np.int64)[:, None] + np.arange(2)) % n_bins
    return bins, np.stack([1.0 - upper_shares, upper_shares], axis=1)
