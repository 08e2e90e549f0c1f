"""The eigen part of a description as one would write it from the paper: what ours is measured against.

Plain numpy and scipy at their defaults, nothing left out for speed and nothing slowed down: 200 eigenpairs
by `eigsh` for each η, all pairs of distances with a sort. Its pairs and distances are the oracle of what ours
lose.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import eigsh
from scipy.spatial import cKDTree
from scipy.spatial.distance import cdist, pdist

from index.vocabulary import Words
from worker.arrays import FloatArray, IntArray
from worker.parameters import Operator, Parameters

N_PAIRS = 200
SHIFT = -1e-6  # about which `eigsh` inverts: below the eigenvalue 0, whose matrix is singular


@dataclass(frozen=True, kw_only=True, eq=False)
class Pairs:
    """Eigenpairs, ascending."""

    values: FloatArray  # (k,)
    functions: FloatArray  # (n, k)


def describe_naively(
    vertices: FloatArray,
    faces: IntArray,
    lab: FloatArray,
    parameters: Parameters,
    words: Mapping[str, Words],
) -> dict[str, FloatArray]:
    """Return bags by block, and quantiles of geometric and joint distances."""
    areas = areas_of(vertices, faces)
    pairs = {}
    for weight in sorted({*parameters.colour_weights, *parameters.distance_weights}):
        points = np.hstack([vertices, weight * lab])
        pairs[weight] = exact_pairs(*operator_of(points, faces, parameters))
    found = {}
    for weight in parameters.colour_weights:
        signatures = signatures_of(pairs[weight], parameters.times)
        found[f"hks-{weight:g}"] = bag_of(signatures, areas, words[f"hks-{weight:g}"])
    signatures = np.diff(np.log(signatures_of(pairs[0.0], parameters.fine_times)), axis=1)
    found["log-hks"] = bag_of(signatures, areas, words["log-hks"])
    samples = farthest(vertices, parameters.distance_samples)
    nearest = cdist(vertices, vertices[samples]).argmin(axis=1)
    shares = np.bincount(nearest, areas, len(samples)).astype(np.float64)
    for name, weights in (("diffusion-geometric", (0.0,)), ("diffusion-joint", parameters.distance_weights)):
        sampled = [
            Pairs(values=pairs[weight].values, functions=pairs[weight].functions[samples])
            for weight in weights
        ]
        distances, cumulative = distribution_of(sampled, parameters.distance_times, shares)
        levels = (np.arange(parameters.distance_quantiles) + 0.5) / parameters.distance_quantiles
        found[name] = np.interp(levels, cumulative, distances)
    return found


def areas_of(points: FloatArray, faces: IntArray) -> FloatArray:
    """Return a third of the area of the faces around each vertex, (n,)."""
    corners = points[faces]
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    squares = (first**2).sum(axis=1) * (second**2).sum(axis=1) - (first * second).sum(axis=1) ** 2
    areas = np.sqrt(np.maximum(squares, 0.0)) / 2.0
    return np.bincount(faces.ravel(), np.repeat(areas / 3.0, 3), len(points)).astype(np.float64)


def operator_of(
    points: FloatArray, faces: IntArray, parameters: Parameters
) -> tuple[sparse.csc_array, FloatArray]:
    """Assemble W (n, n) and S (n,)."""
    areas = areas_of(points, faces)
    n = len(points)
    if parameters.operator is Operator.COTANGENT:
        rows, columns, weights = _cotangents(points, faces)
    else:
        width = parameters.kernel_width
        radius = np.sqrt(-4.0 * width * np.log(parameters.kernel_tail))
        rows, columns = cKDTree(points).query_pairs(radius, output_type="ndarray").T
        squares = np.sum((points[rows] - points[columns]) ** 2, axis=1)
        weights = areas[rows] * areas[columns] * np.exp(-squares / (4.0 * width)) / (4.0 * np.pi * width**2)
    half = sparse.coo_array((weights, (rows, columns)), shape=(n, n)).tocsc()
    whole = half + half.T
    return sparse.csc_array(sparse.diags_array(whole.sum(axis=1)) - whole), areas


def _cotangents(points: FloatArray, faces: IntArray) -> tuple[IntArray, IntArray, FloatArray]:
    rows, columns, weights = [], [], []
    for corner in range(3):
        apex, start, end = faces[:, corner], faces[:, (corner + 1) % 3], faces[:, (corner + 2) % 3]
        first, second = points[start] - points[apex], points[end] - points[apex]
        product = (first * second).sum(axis=1)
        squares = (first**2).sum(axis=1) * (second**2).sum(axis=1) - product**2
        rows.append(start)
        columns.append(end)
        weights.append(product / np.sqrt(np.maximum(squares, 1e-12)) / 2.0)
    return np.concatenate(rows), np.concatenate(columns), np.concatenate(weights)


def exact_pairs(stiffness: sparse.csc_array, areas: FloatArray, n_pairs: int = N_PAIRS) -> Pairs:
    """Find the smallest eigenpairs of W φ = λ S φ."""
    values, functions = eigsh(stiffness, n_pairs, sparse.diags_array(areas).tocsc(), sigma=SHIFT)
    order = np.argsort(values)
    return Pairs(values=values[order], functions=functions[:, order])


def signatures_of(pairs: Pairs, times: Sequence[float]) -> FloatArray:
    """Return heat kernel signatures, (n, t)."""
    return np.asarray(pairs.functions**2 @ np.exp(-np.outer(pairs.values, times)))


def bag_of(signatures: FloatArray, areas: FloatArray, words: Words) -> FloatArray:
    """Return the soft bag of words, (v,)."""
    squares = cdist((signatures - words.centre) / words.spread, words.words, "sqeuclidean")
    shares = np.exp(-squares / (2.0 * words.softness**2))
    shares /= np.maximum(shares.sum(axis=1, keepdims=True), np.finfo(float).tiny)
    return np.asarray(areas @ shares / areas.sum())


def farthest(points: FloatArray, n_samples: int) -> IntArray:
    """Pick points one by one, each the farthest from those before."""
    picked = [int(np.argmax(np.linalg.norm(points - points.mean(axis=0), axis=1)))]
    nearest = np.linalg.norm(points - points[picked[0]], axis=1)
    while len(picked) < min(n_samples, len(points)):
        picked.append(int(np.argmax(nearest)))
        nearest = np.minimum(nearest, np.linalg.norm(points - points[picked[-1]], axis=1))
    return np.array(picked)


def distribution_of(
    sampled: Sequence[Pairs], times: Sequence[float], shares: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return diffusion distances, ascending from each point to itself, and the share of pairs up to each."""
    total = np.zeros(len(shares) * (len(shares) - 1) // 2)
    for time in times:
        product = np.ones_like(total)
        for pairs in sampled:
            product *= pdist(pairs.functions[:, 1:] * np.exp(-pairs.values[1:] * time))
        total += product / len(times)
    weights = 2.0 * products_of(shares / shares.sum())
    order = np.argsort(total)
    own = np.sum((shares / shares.sum()) ** 2)
    return np.r_[0.0, total[order]], np.r_[own, own + np.cumsum(weights[order])]


def products_of(shares: FloatArray) -> FloatArray:
    """Return s_i s_j for i < j in the order of `pdist`."""
    first, second = np.triu_indices(len(shares), 1)
    return shares[first] * shares[second]
