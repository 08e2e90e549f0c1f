"""Colours of an explanation: red where most of the difference lies, pale where next to nothing does."""

import numpy as np
import pytest

from index.methods import METHODS, method, with_weights
from index.vocabulary import default_vocabulary
from service.why.explaining import explain
from service.why.scale import COLOURS, colours_of, faint_density, scale_of
from tests.painted import BLUE, ORANGE, PLACED_METHODS, is_head, side


def test_half_of_what_is_placed_has_the_strongest_colour() -> None:
    random = np.random.default_rng(0)
    densities, shares = random.exponential(5.0, 4000), np.full(4000, 1 / 2000)
    scale = scale_of(densities, shares, method("fused"))
    strongest = densities >= scale
    assert (densities * shares)[strongest].sum() == pytest.approx((densities * shares).sum() / 2, rel=0.01)


def test_a_small_region_that_holds_the_difference_sets_the_scale_and_a_single_point_does_not() -> None:
    shares = np.full(4000, 1 / 2000)
    densities = np.full(4000, 0.01)
    densities[:40] = 6.0  # a hundredth of the area
    assert scale_of(densities, shares, method("fused")) == 6.0
    densities[0] = 100.0
    assert scale_of(densities, shares, method("fused")) == 6.0


def test_the_order_of_points_does_not_matter() -> None:
    random = np.random.default_rng(1)
    densities, shares = random.exponential(5.0, 500), random.uniform(0, 1, 500)
    turned = random.permutation(500)
    one = scale_of(densities, shares, method("fused"))
    assert scale_of(densities[turned], shares[turned], method("fused")) == one


@pytest.mark.parametrize("name", PLACED_METHODS)
def test_what_is_next_to_nothing_stays_pale(name: str) -> None:
    noise = np.random.default_rng(2).uniform(0, 0.2, 1000) * faint_density(METHODS[name])
    scale = scale_of(noise, np.full(1000, 1 / 500), METHODS[name])
    assert scale == faint_density(METHODS[name])
    assert np.abs(colours_of(noise, scale) - colours_of(np.zeros(1), scale)).max() < 0.4


def test_the_least_scale_follows_the_weights_that_count() -> None:
    fused = method("fused")
    without = with_weights(fused, {"colour-curves": 0.0, "colour-histogram": 0.0})
    assert faint_density(without) == pytest.approx(faint_density(fused) / 3, rel=0.01)


def test_colours_go_from_grey_over_yellow_and_orange_to_red() -> None:
    found = np.rint(255 * colours_of(np.array([0.0, 1.0, 2.0, 3.0, 99.0]), 3.0)).astype(int)
    stops = [[int(colour[i : i + 2], 16) for i in (1, 3, 5)] for colour in COLOURS]
    assert found.tolist() == [*stops, stops[-1]]
    halfway = 255 * colours_of(np.array([0.5]), 3.0)[0]
    np.testing.assert_allclose(halfway, (np.array(stops[0]) + stops[1]) / 2)


def test_the_head_that_differs_is_red_and_the_rest_is_pale() -> None:
    one, other = side(ORANGE), side(BLUE)
    found = explain(one, other, method("fused"), default_vocabulary())
    for surface, densities in ((one, found.query), (other, found.result)):
        head, strength = is_head(surface.vertices), np.minimum(densities / found.scale, 1.0)
        assert np.average(strength[head], weights=surface.shares[head]) > 0.7
        assert np.average(strength[~head], weights=surface.shares[~head]) < 0.1
