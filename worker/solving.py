"""Spectra of surfaces: the operator that the parameters name, and its eigenpairs."""

from scipy import sparse

from worker.arrays import FloatArray, IntArray
from worker.geometry.areas import edge_lengths, triangle_areas, vertex_areas
from worker.geometry.laplacian import cotangent_laplacian, joint_embedding, mesh_laplacian
from worker.geometry.spectrum import Eigenpairs, solve_eigenpairs
from worker.parameters import Operator, Parameters


def solve_joint(
    vertices: FloatArray, faces: IntArray, lab: FloatArray, weight: float, parameters: Parameters
) -> Eigenpairs:
    """Solve the operator of geometry and colour joined with weight η.

    Parameters
    ----------
    vertices, lab : (n, 3) arrays
        Units of the canonical area; CIE Lab, which does not matter at η = 0.
    faces : (m, 3) array
    weight : float
        η.
    parameters : Parameters

    Returns
    -------
    Eigenpairs
        All below the cutoff: the finer one for η = 0.
    """
    stiffness, mass = operator_of(vertices, faces, lab, weight, parameters)
    cutoff = parameters.cutoff if weight else parameters.fine_cutoff
    return solve_eigenpairs(vertices, stiffness, mass, cutoff, parameters.eigenpairs)


def operator_of(
    vertices: FloatArray, faces: IntArray, lab: FloatArray, weight: float, parameters: Parameters
) -> tuple[sparse.csc_array, FloatArray]:
    """Return W (n, n) and the diagonal of A (n,); arguments as for `solve_joint`."""
    points = joint_embedding(vertices, lab, weight)
    if parameters.operator is Operator.COTANGENT:
        return cotangent_laplacian(points, faces)
    mass = areas_of(points, faces)
    return mesh_laplacian(points, mass, parameters.kernel_width, parameters.kernel_tail)


def areas_of(points: FloatArray, faces: IntArray) -> FloatArray:
    """Return the area that belongs to each vertex, (n,)."""
    return vertex_areas(faces, triangle_areas(edge_lengths(points, faces)), len(points))
