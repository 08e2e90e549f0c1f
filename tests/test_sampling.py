import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from worker.geometry.sampling import cell_areas, farthest_points


@given(st.integers(0, 2**32 - 1), st.integers(1, 60))
def test_each_sample_is_the_farthest_from_those_before(seed: int, n_samples: int) -> None:
    points = np.random.default_rng(seed).standard_normal((50, 3))
    samples = farthest_points(points, n_samples)
    assert len(set(samples)) == min(n_samples, 50)
    distances = np.linalg.norm(points[:, None] - points[None], axis=2)
    for k in range(1, len(samples)):
        nearest = distances[:, samples[:k]].min(axis=1)
        np.testing.assert_allclose(nearest[samples[k]], nearest.max())


def test_cells_share_out_the_whole_area() -> None:
    random = np.random.default_rng(0)
    points, areas = random.standard_normal((200, 3)), random.uniform(0, 1, 200)
    cells = cell_areas(points, farthest_points(points, 20), areas)
    assert (cells > 0).all()
    np.testing.assert_allclose(cells.sum(), areas.sum())


@given(st.integers(0, 2**32 - 1), st.integers(2, 400))
def test_picking_by_buckets_is_picking_by_all_distances(seed: int, n_points: int) -> None:
    points = (
        np.random.default_rng(seed).integers(0, 12, (n_points, 3)).astype(np.float64)
    )  # many are equally far
    samples = farthest_points(points, n_points)
    nearest = np.full(n_points, np.inf)
    for k in range(1, len(samples)):
        nearest = np.minimum(nearest, np.sum((points - points[samples[k - 1]]) ** 2, axis=1))
        assert samples[k] == nearest.argmax()
