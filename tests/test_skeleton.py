"""Bodies bend at their joints and nowhere else."""

import numpy as np
import pytest

from service.samples.builder import BodyBuilder
from service.samples.flesh import Skin
from service.samples.skeleton import Body, move, transforms


def _arm() -> Body:
    builder = BodyBuilder("arm", (0.0, 0.0, 0.0))
    builder.limb("arm", "root", [(0, 0, 0), (1, 0, 0), (2, 0, 0)], (0.1, 0.1, 0.1))
    return builder.build(0.02)


def test_the_rest_pose_moves_nothing() -> None:
    points = np.random.default_rng(0).normal(size=(20, 3))
    body = _arm()
    np.testing.assert_allclose(move(body, {}, points, Skin(body).weights(points)), points, atol=1e-12)


def test_what_hangs_below_a_joint_follows_it() -> None:
    body = _arm()
    turns, shifts = transforms(body, {"arm-0": (0, 0, 90)})
    elbow, hand = np.array([1.0, 0, 0]), np.array([2.0, 0, 0])
    np.testing.assert_allclose(turns[2] @ elbow + shifts[2], (0, 1, 0), atol=1e-12)
    np.testing.assert_allclose(turns[2] @ hand + shifts[2], (0, 2, 0), atol=1e-12)


def test_both_joints_turn_one_after_the_other() -> None:
    turns, shifts = transforms(_arm(), {"arm-0": (0, 0, 90), "arm-1": (0, 0, 90)})
    np.testing.assert_allclose(turns[2] @ np.array([2.0, 0, 0]) + shifts[2], (-1, 1, 0), atol=1e-12)


def test_weights_are_shares() -> None:
    points = np.random.default_rng(0).normal(size=(50, 3))
    weights = Skin(_arm()).weights(points)
    assert (weights >= 0).all()
    np.testing.assert_allclose(weights.sum(1), 1.0)


def test_an_unknown_joint_is_refused() -> None:
    with pytest.raises(ValueError, match="has no joint tail"):
        transforms(_arm(), {"tail": (0, 0, 0)})
