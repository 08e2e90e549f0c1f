import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from index.centres import Centres


@given(seed=st.integers(0, 2**32 - 1), n_points=st.integers(1, 50), count=st.integers(1, 60))
def test_the_nearest_are_those_of_brute_force(seed: int, n_points: int, count: int) -> None:
    generator = np.random.default_rng(seed)
    points = generator.normal(size=(n_points, 5)).astype(np.float32)
    query = generator.normal(size=5).astype(np.float32)
    found = Centres(points).nearest(query, count)
    expected = np.sort(np.abs(points - query).sum(axis=1))[:count]
    assert len(found) == len(set(found.tolist())) == min(count, n_points)
    np.testing.assert_allclose(np.abs(points[found] - query).sum(axis=1), expected, rtol=1e-5)


def test_points_of_any_memory_layout_are_read_aright() -> None:
    points = np.asfortranarray(np.arange(30, dtype=np.float32).reshape(10, 3))
    for number in range(10):
        assert Centres(points).nearest(points[number], 1).tolist() == [number]


def test_what_is_infinitely_far_is_not_found() -> None:
    points = np.array([[0.0], [np.inf], [1.0]], np.float32)
    assert Centres(points).nearest(np.zeros(1, np.float32), 3).tolist() == [0, 2]
