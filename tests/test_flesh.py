"""The skin's field is that of its cones, melted."""

import numpy as np
import pytest

from service.samples.builder import BodyBuilder
from service.samples.creatures import KINDS
from service.samples.flesh import Skin
from service.samples.proportions import Proportions


def test_a_ball_is_a_ball() -> None:
    builder = BodyBuilder("ball", (0.0, 0.0, 0.0))
    builder.ball("root", (1.0, 2.0, 3.0), 0.5)
    points = np.random.default_rng(0).normal(size=(100, 3)) + (1, 2, 3)
    expected = np.linalg.norm(points - (1, 2, 3), axis=1) - 0.5
    np.testing.assert_allclose(Skin(builder.build(0.01))(points), expected, atol=1e-9)


def test_a_flat_cone_is_thinner_along_its_axis() -> None:
    builder = BodyBuilder("coin", (0.0, 0.0, 0.0))
    builder.cone("root", (0, 0, 0), (0, 0, 0), (1.0, 1.0), flat=((0.0, 1.0, 0.0), 4.0))
    skin = Skin(builder.build(0.001))
    np.testing.assert_allclose(skin(np.array([(1.0, 0, 0), (0, 0.25, 0), (0, 0, -1)])), 0.0, atol=1e-9)


@pytest.mark.parametrize("kind", sorted(KINDS))
def test_near_misses_no_surface(kind: str) -> None:
    skin = Skin(KINDS[kind].body(Proportions()))
    lower, upper = skin.bounds
    points = np.random.default_rng(0).uniform(lower, upper, (4000, 3))
    radius = 0.1
    towards = np.random.default_rng(1).normal(size=points.shape)
    beside = points + radius * towards / np.linalg.norm(towards, axis=1, keepdims=True)
    crossed = (skin(points) < 0) != (skin(beside) < 0)
    assert crossed.sum() > 20
    assert skin.near(points, radius)[crossed].all()


@pytest.mark.parametrize("kind", sorted(KINDS))
def test_the_bounds_hold_the_whole_skin(kind: str) -> None:
    skin = Skin(KINDS[kind].body(Proportions()))
    lower, upper = skin.bounds
    generator = np.random.default_rng(0)
    on_border = generator.uniform(lower, upper, (2000, 3))
    axis, end = generator.integers(0, 3, 2000), generator.integers(0, 2, 2000)
    on_border[np.arange(2000), axis] = np.stack([lower, upper])[end, axis]
    assert (skin(on_border) > 0).all()
