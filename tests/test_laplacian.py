import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from tests.shapes import sheet, sphere
from worker.arrays import FloatArray, IntArray
from worker.descriptors.signatures import heat_kernel_signatures
from worker.geometry.areas import edge_lengths, triangle_areas, vertex_areas
from worker.geometry.laplacian import cotangent_laplacian, joint_embedding, mesh_laplacian
from worker.geometry.resampling import normalise_area
from worker.geometry.spectrum import solve_eigenpairs
from worker.parameters import Parameters

PARAMETERS = Parameters()


def hks(points: FloatArray, faces: IntArray) -> FloatArray:
    pairs = solve_eigenpairs(points, *cotangent_laplacian(points, faces), PARAMETERS.cutoff)
    return heat_kernel_signatures(pairs.eigenvalues, pairs.eigenfunctions, np.array(PARAMETERS.times))


def bumpy() -> tuple[FloatArray, IntArray]:
    """Return a sphere with bumps, without symmetry, of the canonical area."""
    vertices, faces = sphere(4)
    vertices = vertices * (
        1 + 0.3 * np.sin(3 * vertices[:, :1] + 1) * np.cos(4 * vertices[:, 1:2] + vertices[:, 2:])
    )
    return normalise_area(vertices, faces, PARAMETERS.surface_area), faces


@settings(max_examples=3)
@given(st.integers(0, 2**32 - 1))
def test_hks_is_the_same_when_turned_moved_and_numbered_anew(seed: int) -> None:
    random = np.random.default_rng(seed)
    vertices, faces = bumpy()
    expected = hks(vertices, faces)
    order = random.permutation(len(vertices))
    moved = Rotation.random(rng=random).apply(vertices) + random.uniform(-100, 100, 3)
    new_faces = np.argsort(order)[faces][random.permutation(len(faces))]
    np.testing.assert_allclose(hks(moved[order], new_faces), expected[order], rtol=1e-8)


def test_hks_is_the_same_at_any_scale_after_normalisation() -> None:
    vertices, faces = bumpy()
    scaled = normalise_area(vertices * 1e-3 + 5.0, faces, PARAMETERS.surface_area)
    np.testing.assert_allclose(hks(scaled, faces), hks(vertices, faces), rtol=1e-8)


def test_bending_a_sheet_changes_hks_by_less_than_1_percent() -> None:
    vertices, faces = sheet(50, 120.0, 158.3)
    radius = 40.0
    angles = vertices[:, 0] / radius
    bent = np.column_stack([radius * np.sin(angles), vertices[:, 1], radius * (1 - np.cos(angles))])
    np.testing.assert_allclose(hks(bent, faces), hks(vertices, faces), rtol=0.01)


def test_the_joint_operator_without_colour_is_the_geometric_one() -> None:
    vertices, faces = bumpy()
    lab = np.random.default_rng(0).uniform(0, 100, vertices.shape)
    np.testing.assert_array_equal(joint_embedding(vertices, lab, 0.0), vertices)
    flat = np.hstack([vertices, 0.0 * lab])  # the same in six dimensions
    stiffness, areas = cotangent_laplacian(vertices, faces)
    joint_stiffness, joint_areas = cotangent_laplacian(flat, faces)
    np.testing.assert_allclose((stiffness - joint_stiffness).toarray(), 0.0, atol=1e-12)
    np.testing.assert_allclose(areas, joint_areas, rtol=1e-12)


def test_a_colour_gradient_stretches_the_surface_as_the_metric_says() -> None:
    vertices, faces = sheet(10, 100.0, 100.0)
    lab = np.column_stack([vertices[:, 0], np.zeros((len(vertices), 2))])  # L rises by 1 a unit along x
    _, areas = cotangent_laplacian(joint_embedding(vertices, lab, 0.5), faces)
    np.testing.assert_allclose(areas.sum(), 1e4 * np.sqrt(1 + 0.5**2))


def test_both_operators_are_symmetric_and_kill_constants() -> None:
    vertices, faces = bumpy()
    areas = vertex_areas(faces, triangle_areas(edge_lengths(vertices, faces)), len(vertices))
    for stiffness, _ in (cotangent_laplacian(vertices, faces), mesh_laplacian(vertices, areas, 2.0, 1e-6)):
        assert abs(stiffness - stiffness.T).max() < 1e-12 * abs(stiffness).max()
        np.testing.assert_allclose(stiffness @ np.ones(len(vertices)), 0.0, atol=1e-10)


def test_intrinsic_delaunay_leaves_no_negative_weight() -> None:
    vertices, faces = sheet(12, 1.0, 0.1)  # long thin triangles
    vertices[:, 2] = 0.05 * np.sin(20 * vertices[:, 0])
    weights = cotangent_laplacian(vertices, faces)[0].tocoo()
    assert weights.data[weights.row != weights.col].max() <= 1e-9


def test_mesh_laplace_is_the_formula_of_the_paper() -> None:
    vertices, faces = sphere(2)
    vertices = normalise_area(vertices, faces, 600.0)
    areas = vertex_areas(faces, triangle_areas(edge_lengths(vertices, faces)), len(vertices))
    width = 2.0
    squares = np.sum((vertices[:, None] - vertices[None]) ** 2, axis=2)
    kernel = areas[:, None] * areas * np.exp(-squares / (4 * width))
    expected = (np.diag(kernel.sum(axis=1)) - kernel) / (4 * np.pi * width**2)
    found = mesh_laplacian(vertices, areas, width, 1e-6)[0].toarray()
    np.testing.assert_allclose(found, expected, atol=1e-5 * expected.max())
