"""The distance of two shapes is shared out among blocks and vertices, and lies where they differ."""

import numpy as np
import pytest

from index.distances import distances
from index.layout import Layout
from index.methods import method, with_weights
from index.vocabulary import default_vocabulary
from service.why.explaining import explain
from tests.painted import BLUE, ORANGE, PLACED_METHODS, is_head, side

WORDS = default_vocabulary()


@pytest.mark.parametrize("name", PLACED_METHODS)
def test_contributions_are_the_distance_that_a_search_takes(name: str) -> None:
    one, other, chosen = side(ORANGE), side(BLUE), method(name)
    layout = Layout.of(chosen, one.blocks)
    rows = np.stack([layout.join(one.blocks), layout.join(other.blocks)])
    (searched,) = distances(rows, np.array([1]), rows[0], layout, chosen)
    found = explain(one, other, chosen, WORDS)
    assert found.distance == pytest.approx(searched, rel=1e-6)
    assert sum(part.contribution for part in found.parts) == pytest.approx(found.distance)
    assert sum(found.share(part) for part in found.parts) == pytest.approx(1.0 if searched else 0.0)


@pytest.mark.parametrize("name", PLACED_METHODS)
def test_all_of_it_but_colours_too_fine_for_the_mesh_lies_on_the_two_surfaces(name: str) -> None:
    one, other = side(ORANGE), side(BLUE)
    found = explain(one, other, method(name), WORDS)
    for part in found.parts:
        placed = one.shares @ part.query + other.shares @ part.result
        assert placed == pytest.approx(part.placed * part.contribution)
        assert part.placed > (0.9 if part.block.name == "colour-histogram" else 1 - 1e-6)
    assert min(found.query.min(), found.result.min()) >= 0


def test_a_head_of_another_colour_is_where_most_of_the_difference_lies_on_both() -> None:
    one, other = side(ORANGE), side(BLUE)
    found = explain(one, other, method("fused"), WORDS)
    for surface, densities in ((one, found.query), (other, found.result)):
        head = is_head(surface.vertices)
        masses = surface.shares * densities
        assert surface.shares[head].sum() < 0.2
        assert masses[head].sum() > 0.8 * masses.sum()


def test_swapping_the_two_shapes_swaps_the_surfaces_and_nothing_else() -> None:
    there = explain(side(ORANGE), side(BLUE), method("fused"), WORDS)
    back = explain(side(BLUE), side(ORANGE), method("fused"), WORDS)
    np.testing.assert_array_equal(there.query, back.result)
    np.testing.assert_array_equal(there.result, back.query)
    assert there.scale == pytest.approx(back.scale)
    assert there.distance == back.distance


@pytest.mark.parametrize("name", PLACED_METHODS)
def test_a_shape_differs_nowhere_from_itself(name: str) -> None:
    found = explain(side(ORANGE), side(ORANGE), method(name), WORDS)
    assert found.distance == 0
    assert not found.query.any()
    assert not found.result.any()
    assert found.scale > 0


def test_a_block_without_weight_adds_nothing_anywhere() -> None:
    one, other = side(ORANGE), side(BLUE)
    shape_alone = with_weights(method("fused"), {"colour-histogram": 0.0, "colour-curves": 0.0})
    found = explain(one, other, shape_alone, WORDS)
    colours = [part for part in found.parts if part.block.name != "log-hks"]
    assert all(part.contribution == 0 and part.distance > 0 and not part.query.any() for part in colours)
    doubled = with_weights(method("fused"), {"colour-histogram": 2.0})
    single = explain(one, other, with_weights(method("fused"), {"colour-histogram": 1.0}), WORDS)
    twice = explain(one, other, doubled, WORDS)
    np.testing.assert_allclose(twice.parts[1].query, 2 * single.parts[1].query)
