import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from worker.geometry.assembly import laplacian_of


@given(st.integers(0, 2**32 - 1), st.integers(1, 20), st.integers(0, 80))
def test_the_matrix_is_the_sum_over_edges(seed: int, n_vertices: int, n_edges: int) -> None:
    random = np.random.default_rng(seed)
    tails, heads = random.integers(0, n_vertices, (2, n_edges))  # some twice, some from a vertex to itself
    weights = random.standard_normal(n_edges)
    expected = np.zeros((n_vertices, n_vertices))
    for tail, head, weight in zip(tails, heads, weights, strict=True):
        step = (np.arange(n_vertices) == tail).astype(float) - (np.arange(n_vertices) == head)
        expected += weight * np.outer(step, step)
    found = laplacian_of(tails, heads, weights, n_vertices)
    np.testing.assert_allclose(found.toarray(), expected, atol=1e-12)
    assert found.has_canonical_format
