import numpy as np
import pytest

from index.errors import FingerprintMismatch
from index.vocabulary import learn_vocabulary
from service.quantisation import quantise, require_same
from tests.test_vocabulary import made_signatures


def test_bags_sum_to_1_and_distributions_rise() -> None:
    shapes = [made_signatures(seed) for seed in range(3)]
    blocks = quantise(shapes[0], learn_vocabulary(shapes, "f"))
    sizes = {"hks-0": 48, "hks-0.05": 48, "hks-0.1": 48, "log-hks": 128, "meshhog": 48}
    for name, size in sizes.items():
        assert blocks[name].shape == (size,)
        np.testing.assert_allclose(blocks[name].sum(), 1.0, rtol=1e-5)
    for name in ("diffusion-geometric", "diffusion-joint"):
        assert (np.diff(blocks[name]) >= 0).all()
        assert blocks[name][-1] * len(blocks[name]) <= 1.0


def test_a_shape_without_features_has_an_empty_bag_of_them() -> None:
    shapes = [made_signatures(seed) for seed in range(3)]
    vocabulary = learn_vocabulary(shapes, "f")
    plain = shapes[0] | {"meshhog": shapes[0]["meshhog"][:0]}
    np.testing.assert_array_equal(quantise(plain, vocabulary)["meshhog"], np.zeros(48))


def test_the_order_of_points_does_not_matter() -> None:
    shapes = [made_signatures(seed) for seed in range(3)]
    vocabulary = learn_vocabulary(shapes, "f")
    order = np.random.default_rng(0).permutation(300)
    points = ("areas", "hks-0", "hks-0.05", "hks-0.1", "log-hks")
    shuffled = {name: array[order] if name in points else array for name, array in shapes[0].items()}
    expected = quantise(shapes[0], vocabulary)
    for name, block in quantise(shuffled, vocabulary).items():
        np.testing.assert_allclose(block, expected[name], atol=1e-6)


def test_other_parameters_are_not_mixed() -> None:
    vocabulary = learn_vocabulary([made_signatures(0), made_signatures(1)], "f")
    require_same("f", vocabulary)
    with pytest.raises(FingerprintMismatch):
        require_same("g", vocabulary)
