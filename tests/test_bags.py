import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from worker.descriptors.bags import bag_of_features, soft_assignment


@given(st.integers(0, 2**32 - 1), st.just(0.0) | st.floats(1e-3, 10.0))
def test_a_bag_sums_to_1_and_is_not_negative(seed: int, softness: float) -> None:
    random = np.random.default_rng(seed)
    bag = bag_of_features(
        random.standard_normal((30, 4)), random.uniform(0.1, 1, 30), random.standard_normal((6, 4)), softness
    )
    np.testing.assert_allclose(bag.sum(), 1.0)
    assert (bag >= 0).all()


@pytest.mark.parametrize("offset", [0.0, 1e4])
def test_shares_are_the_formula(offset: float) -> None:
    random = np.random.default_rng(0)
    points, words = random.standard_normal((20, 3)) + offset, random.standard_normal((5, 3)) + offset
    expected = np.exp(-np.sum((points[:, None] - words) ** 2, axis=2) / (2 * 0.7**2))
    expected /= expected.sum(axis=1, keepdims=True)
    np.testing.assert_allclose(soft_assignment(points, words, 0.7), expected, atol=1e-6)


def test_without_softness_each_area_goes_to_the_nearest_word() -> None:
    points = np.array([[0.1], [0.9], [1.2]])
    bag = bag_of_features(points, np.array([1.0, 2.0, 5.0]), np.array([[0.0], [1.0]]), 0.0)
    np.testing.assert_allclose(bag, [1 / 8, 7 / 8])


def test_a_point_far_from_every_word_still_counts() -> None:
    bag = bag_of_features(np.array([[1e6]]), np.array([1.0]), np.array([[0.0], [1.0]]), 0.1)
    np.testing.assert_allclose(bag, [0.0, 1.0])
