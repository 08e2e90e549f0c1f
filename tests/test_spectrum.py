from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import linalg, sparse

from tests.shapes import sheet, sphere
from worker.arrays import FloatArray
from worker.descriptors.signatures import heat_kernel_signatures
from worker.errors import Code, MeshError
from worker.geometry.areas import edge_lengths, triangle_areas, vertex_areas
from worker.geometry.laplacian import cotangent_laplacian, mesh_laplacian
from worker.geometry.resampling import normalise_area
from worker.geometry.spectrum import count_below, solve_eigenpairs, system_of
from worker.parameters import Parameters

PARAMETERS = Parameters()
RADIUS_SQUARED = PARAMETERS.surface_area / (4 * np.pi)  # of a sphere of the canonical area
OPERATORS = ["cotangent", "mesh-laplace"]
HARMONICS = np.repeat([0.0, 2.0, 6.0], [1, 3, 5])  # l (l + 1), 2 l + 1 times each


def operator(name: str) -> tuple[FloatArray, sparse.csc_array, FloatArray]:
    """Discretise a sphere of the canonical area with 2 562 vertices: those, W and S."""
    vertices, faces = sphere(4)
    vertices = normalise_area(vertices, faces, PARAMETERS.surface_area)
    if name == "cotangent":
        return vertices, *cotangent_laplacian(vertices, faces)
    areas = vertex_areas(faces, triangle_areas(edge_lengths(vertices, faces)), len(vertices))
    return vertices, *mesh_laplacian(vertices, areas, PARAMETERS.kernel_width, PARAMETERS.kernel_tail)


@pytest.mark.parametrize("name", OPERATORS)
def test_a_sphere_has_the_eigenvalues_of_spherical_harmonics_within_1_percent(name: str) -> None:
    found = solve_eigenpairs(*operator(name), PARAMETERS.cutoff).eigenvalues * RADIUS_SQUARED
    np.testing.assert_allclose(found[:9], HARMONICS, rtol=0.01, atol=1e-9)


@pytest.mark.parametrize("name", OPERATORS)
def test_eigenfunctions_are_orthonormal_in_the_area_inner_product(name: str) -> None:
    points, stiffness, areas = operator(name)
    functions = solve_eigenpairs(points, stiffness, areas, PARAMETERS.cutoff).eigenfunctions
    products = functions.T @ (areas[:, None] * functions)
    np.testing.assert_allclose(products, np.eye(len(products)), atol=1e-10)
    np.testing.assert_allclose(areas.sum(), PARAMETERS.surface_area, rtol=0.01)


@pytest.mark.parametrize("name", OPERATORS)
def test_the_area_integral_of_hks_is_the_heat_trace(name: str) -> None:
    points, stiffness, areas = operator(name)
    pairs = solve_eigenpairs(points, stiffness, areas, PARAMETERS.cutoff)
    times = np.array(PARAMETERS.times)
    integral = areas @ heat_kernel_signatures(pairs.eigenvalues, pairs.eigenfunctions, times)
    trace = np.exp(-np.outer(pairs.eigenvalues, times)).sum(axis=0)
    np.testing.assert_allclose(integral, trace, rtol=1e-10)


@pytest.mark.parametrize("name", OPERATORS)
def test_pairs_below_the_cutoff_give_the_hks_of_200_pairs_within_1e_6(name: str) -> None:
    points, stiffness, areas = operator(name)
    few = solve_eigenpairs(points, stiffness, areas, PARAMETERS.cutoff)
    many = solve_eigenpairs(points, stiffness, areas, 1.0, most=200)
    assert len(few.eigenvalues) < 60
    assert len(many.eigenvalues) == 200
    times = np.array(PARAMETERS.times)
    expected = heat_kernel_signatures(many.eigenvalues, many.eigenfunctions, times)
    found = heat_kernel_signatures(few.eigenvalues, few.eigenfunctions, times)
    np.testing.assert_allclose(found, expected, rtol=1e-6)


def test_sparse_and_dense_solvers_agree() -> None:
    points, stiffness, areas = operator("cotangent")
    scale = 1 / np.sqrt(areas)
    expected = linalg.eigvalsh(scale[:, None] * stiffness.toarray() * scale, subset_by_value=(-1.0, 0.017))
    found = solve_eigenpairs(points, stiffness, areas, 0.017).eigenvalues
    np.testing.assert_allclose(found, expected, rtol=1e-8, atol=1e-12)


@settings(max_examples=25)
@given(st.integers(0, 2**32 - 1), st.floats(0.01, 30.0))
def test_the_inertia_counts_the_eigenvalues(seed: int, value: float) -> None:
    vertices, faces = sheet(7)
    vertices = vertices + 0.03 * np.random.default_rng(seed).standard_normal(vertices.shape)
    stiffness, areas = cotangent_laplacian(vertices, faces)
    scale = 1 / np.sqrt(areas)
    expected = linalg.eigvalsh(scale[:, None] * stiffness.toarray() * scale)
    assert count_below(system_of(vertices, stiffness, areas), value) == np.count_nonzero(expected < value)


def test_each_of_many_pieces_keeps_its_constant_function() -> None:
    one, triangles = sheet(2, 3.0, 3.0)
    pieces = [one + np.array([10.0 * k, 0, 0]) for k in range(300)]
    faces = np.vstack([triangles + len(one) * k for k in range(300)])
    points = np.vstack(pieces)
    pairs = solve_eigenpairs(points, *cotangent_laplacian(points, faces), PARAMETERS.cutoff)
    np.testing.assert_allclose(pairs.eigenvalues, np.zeros(300), atol=1e-12)
    signatures = heat_kernel_signatures(pairs.eigenvalues, pairs.eigenfunctions, np.array([1024.0]))
    np.testing.assert_allclose(signatures, 1 / 9.0, rtol=1e-9)  # one over the area of the piece


def test_the_cap_keeps_the_smallest() -> None:
    points, stiffness, areas = operator("cotangent")
    pairs = solve_eigenpairs(points, stiffness, areas, PARAMETERS.cutoff, most=9)
    np.testing.assert_allclose(pairs.eigenvalues * RADIUS_SQUARED, HARMONICS, rtol=0.01, atol=1e-9)


def test_an_operator_that_cannot_be_factored_is_refused() -> None:
    system = system_of(np.zeros((500, 3)), sparse.csc_array(np.ones((500, 500))), np.ones(500))
    with pytest.raises(MeshError) as refusal:
        count_below(replace(system, diagonal=np.full(500, np.nan)), 1.0)
    assert refusal.value.code is Code.UNSOLVED


def test_a_cap_far_below_the_number_of_pairs_keeps_the_smallest() -> None:
    vertices, faces = sheet(21)
    stiffness, areas = cotangent_laplacian(vertices, faces)
    scale = 1 / np.sqrt(areas)
    expected = linalg.eigvalsh(scale[:, None] * stiffness.toarray() * scale)[:30]
    found = solve_eigenpairs(vertices, stiffness, areas, 4_000.0, most=30).eigenvalues
    np.testing.assert_allclose(found, expected, rtol=1e-8, atol=1e-9)


@pytest.mark.parametrize("cutoff", [PARAMETERS.cutoff, PARAMETERS.fine_cutoff])
def test_eigenfunctions_satisfy_the_equation(cutoff: float) -> None:
    points, stiffness, areas = operator("cotangent")
    pairs = solve_eigenpairs(points, stiffness, areas, cutoff)
    functions = pairs.eigenfunctions
    residuals = (stiffness @ functions) / areas[:, None] - functions * pairs.eigenvalues
    # The iteration ends at 1e-7 of the inverted operator; how far below it gets, processors decide.
    assert np.sqrt(areas @ residuals**2).max() < 1e-6 * cutoff


def test_the_constant_function_is_constant_to_the_last_digits() -> None:
    points, stiffness, areas = operator("cotangent")
    pairs = solve_eigenpairs(points, stiffness, areas, PARAMETERS.cutoff)
    assert pairs.eigenvalues[0] == 0.0
    np.testing.assert_allclose(pairs.eigenfunctions[:, 0], 1 / np.sqrt(areas.sum()), rtol=1e-14)
