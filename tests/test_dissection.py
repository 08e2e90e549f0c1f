import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from tests.shapes import sheet, sphere
from worker.geometry.dissection import LEAF, dissect
from worker.geometry.laplacian import cotangent_laplacian


@given(st.integers(0, 2**32 - 1), st.integers(1, 200))
def test_every_vertex_is_in_one_group(seed: int, n_vertices: int) -> None:
    random = np.random.default_rng(seed)
    graph = random.random((n_vertices, n_vertices)) < 0.05
    starts = np.r_[0, np.cumsum((graph | graph.T).sum(axis=0))]
    neighbours = np.nonzero((graph | graph.T).T)[1]
    order, groups = dissect(random.standard_normal((n_vertices, 3)), starts, neighbours)
    np.testing.assert_array_equal(np.sort(order), np.arange(n_vertices))
    assert groups[0] == 0
    assert groups[-1] == n_vertices
    assert (np.diff(groups) > 0).all()


def test_a_sheet_is_cut_along_its_middle() -> None:
    vertices, faces = sheet(40, 2.0, 1.0)
    stiffness = cotangent_laplacian(vertices, faces)[0]
    order, groups = dissect(vertices, stiffness.indptr.astype(np.int64), stiffness.indices.astype(np.int64))
    separator = vertices[order[groups[-2] :]]
    assert len(separator) == 41
    assert np.ptp(separator[:, :2], axis=0).min() == 0.0  # a line of the grid
    assert np.diff(groups).max() == len(separator)


def test_points_that_coincide_are_not_cut() -> None:
    vertices, faces = sphere(2)
    stiffness = cotangent_laplacian(vertices, faces)[0]
    _, groups = dissect(
        np.zeros_like(vertices), stiffness.indptr.astype(np.int64), stiffness.indices.astype(np.int64)
    )
    assert len(vertices) > LEAF
    np.testing.assert_array_equal(groups, [0, len(vertices)])
