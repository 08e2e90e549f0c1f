"""The Laplacian of a surface in the joint space of geometry and colour, as a symmetric pencil.

Both discretisations return (W, S) of the eigenproblem W φ = λ diag(S) φ, λ ≥ 0, S the areas of the vertices.
"""

import numpy as np
from scipy import sparse
from scipy.spatial import cKDTree

from worker.arrays import FloatArray, IntArray
from worker.geometry.areas import edge_lengths, triangle_areas, vertex_areas
from worker.geometry.assembly import laplacian_of
from worker.geometry.delaunay import intrinsic_delaunay


def joint_embedding(vertices: FloatArray, lab: FloatArray, colour_weight: float) -> FloatArray:
    """Place each vertex in the joint space ξ = (x, y, z, η L, η a, η b).

    Kovnatsky et al. 2011, section 3: the photometric part scaled by η and joined to the geometric one.

    Parameters
    ----------
    vertices : (n, 3) array
        Units of a surface of the canonical area.
    lab : (n, 3) array
        CIE Lab at the vertices.
    colour_weight : float
        η; 0 is geometry alone.

    Returns
    -------
    (n, 6) array, or (n, 3) for η = 0
    """
    if colour_weight == 0:
        return vertices
    return np.hstack([vertices, colour_weight * lab])


def cotangent_laplacian(points: FloatArray, faces: IntArray) -> tuple[sparse.csc_array, FloatArray]:
    """Discretise with linear finite elements on the intrinsic Delaunay triangulation.

    Lengths are measured in the space of the points, so the metric is the one that it induces (Pinkall and
    Polthier 1993 for the weights, Bobenko and Springborn 2007 for the triangulation).

    Parameters
    ----------
    points : (n, d) array
        Vertices, in 3 or 6 dimensions.
    faces : (m, 3) array

    Returns
    -------
    stiffness : (n, n) sparse array
        W, rows sum to 0.
    mass : (n,) array
        S: a third of the area of the faces around each vertex.
    """
    n = len(points)
    faces, lengths = intrinsic_delaunay(faces, edge_lengths(points, faces))
    areas = triangle_areas(lengths)
    squares = lengths * lengths  # (m, 3)
    floor = np.finfo(float).eps * squares.max(initial=0.0)
    quadruple = 4.0 * np.maximum(areas, floor)  # (m,)
    opposite = squares.sum(axis=1)[:, None] - 2.0 * squares  # the squares of both other sides, less its own
    cotangents = opposite / quadruple[:, None]  # opposite to each edge
    heads = faces[:, [1, 2, 0]].ravel()
    stiffness = laplacian_of(faces.ravel(), heads, cotangents.ravel() / 2.0, n)
    return stiffness, vertex_areas(faces, areas, n)


def mesh_laplacian(
    points: FloatArray, areas: FloatArray, kernel_width: float, tail: float
) -> tuple[sparse.csc_array, FloatArray]:
    """Discretise with the heat kernel of the ambient space.

    Belkin, Sun and Wang (2008), "Discrete Laplace operator on meshed surfaces", made symmetric:
    w_ij = S_i S_j exp(−|ξ_i − ξ_j|² / 4ρ), W = diag(Σ_j w_ij) − w, A = 4πρ² diag(S). Both are returned
    divided by 4πρ², so that the eigenfunctions are orthonormal in the area inner product.

    Parameters
    ----------
    points : (n, d) array
        Vertices ξ, in 3 or 6 dimensions.
    areas : (n,) array
        S, vertex areas.
    kernel_width : float
        ρ, squared units.
    tail : float
        Relative weight at which the kernel is cut; also the share of its mass in the plane that this loses.

    Returns
    -------
    stiffness : (n, n) sparse array
        W / 4πρ², rows sum to 0.
    mass : (n,) array
        S, as given.
    """
    radius = float(np.sqrt(-4.0 * kernel_width * np.log(tail)))
    pairs = cKDTree(points).query_pairs(radius, output_type="ndarray")  # (p, 2)
    first, second = np.ascontiguousarray(pairs.T)
    squares = np.zeros(len(first))
    for column in points.T:
        squares += np.square(column[first] - column[second])
    weights = areas[first] * areas[second] * np.exp(squares / (-4.0 * kernel_width))
    weights /= 4.0 * np.pi * kernel_width**2
    return laplacian_of(first, second, weights, len(points)), areas
