import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import sparse

from tests.shapes import sheet, sphere
from worker.arrays import FloatArray
from worker.geometry.elimination import LARGE
from worker.geometry.factors import Factors, factorise
from worker.geometry.fronts import find_fronts
from worker.geometry.laplacian import cotangent_laplacian, mesh_laplacian
from worker.geometry.substitution import SIDES, solve


def factors_of(points: FloatArray, matrix: sparse.csc_array) -> Factors | None:
    starts, rows = matrix.indptr.astype(np.int64), matrix.indices.astype(np.int64)
    return factorise(find_fronts(points, starts, rows), starts, rows, matrix.data, matrix.diagonal())


@settings(max_examples=30)
@given(st.integers(0, 2**32 - 1), st.integers(1, 150))
def test_solutions_and_inertia_are_those_of_the_dense_matrix(seed: int, n: int) -> None:
    random = np.random.default_rng(seed)
    half = np.triu(random.standard_normal((n, n)) * (random.random((n, n)) < 0.05), 1)
    dense = half + half.T + np.diag(random.choice([-1.0, 1.0], n) * random.uniform(1.0, 3.0, n))
    sides = random.standard_normal((SIDES, n))
    factors = factors_of(random.standard_normal((n, 3)), sparse.csc_array(dense))
    assert factors is not None
    assert factors.negative == np.count_nonzero(np.linalg.eigvalsh(dense) < 0)
    residual = dense @ solve(factors, sides).T - sides.T
    np.testing.assert_allclose(residual, 0.0, atol=1e-9 * np.linalg.cond(dense))


@pytest.mark.parametrize("shift", [-0.5, 1.0, 40.0])
def test_pieces_and_vertices_without_edges_are_solved_together(shift: float) -> None:
    (one, faces), (two, triangles) = sheet(12), sphere(2)
    points = np.vstack([one, two, np.full((3, 3), 7.0)])
    stiffness, _ = cotangent_laplacian(points, np.vstack([faces, triangles + len(one)]))
    matrix = sparse.csc_array(stiffness - shift * sparse.eye_array(len(points)))
    factors = factors_of(points, matrix)
    assert factors is not None
    sides = np.random.default_rng(0).standard_normal((SIDES, len(points)))
    np.testing.assert_allclose(matrix @ solve(factors, sides).T, sides.T, atol=1e-8)
    assert factors.negative == np.count_nonzero(np.linalg.eigvalsh(matrix.toarray()) < 0)


def test_fronts_with_wide_panels_are_factored_as_well() -> None:
    points, _ = sphere(4)
    points = points * 10.0
    stiffness, areas = mesh_laplacian(points, np.ones(len(points)), 2.0, 1e-6)
    matrix = sparse.csc_array(stiffness - 0.05 * sparse.diags_array(areas))
    factors = factors_of(points, matrix)
    assert factors is not None
    sizes = np.diff(factors.fronts.groups) + np.diff(factors.fronts.begins)
    assert sizes.max() > LARGE
    sides = np.random.default_rng(1).standard_normal((SIDES, len(points)))
    np.testing.assert_allclose(matrix @ solve(factors, sides).T, sides.T, atol=1e-8)
    assert factors.negative == np.count_nonzero(np.linalg.eigvalsh(matrix.toarray()) < 0)


def test_a_singular_matrix_has_no_factors() -> None:
    points, _ = sphere(0)
    assert factors_of(points[:3], sparse.csc_array(np.zeros((3, 3)))) is None
    pair = sparse.csc_array(np.array([[0.0, 1.0], [1.0, 0.0]]))  # regular, but both pivots are 0
    assert factors_of(points[:2], pair) is None
