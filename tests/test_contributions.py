"""What two surfaces differ in is placed on them wholly, once, and where it is."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from worker.arrays import FloatArray
from worker.descriptors.bags import bag_of_features
from worker.descriptors.contributions import cell_densities, curve_densities, word_densities
from worker.descriptors.curves import colour_curves
from worker.descriptors.histograms import join_bins, lab_histogram
from worker.geometry.colour import srgb_to_lab
from worker.parameters import Parameters

PARAMETERS = Parameters()
BINS = (PARAMETERS.histogram_bins, PARAMETERS.histogram_smoothing)
CELLS = (PARAMETERS.histogram_bins, PARAMETERS.histogram_lightness, PARAMETERS.histogram_chroma)
SEEDS = st.integers(0, 2**32 - 1)
Surface = tuple[FloatArray, FloatArray]  # some numbers of the points, and their shares of the area


def surface(random: np.random.Generator, width: int) -> Surface:
    shares = random.uniform(0.1, 3.0, random.integers(30, 80))
    return random.standard_normal((len(shares), width)), shares / shares.sum()


def coloured(random: np.random.Generator) -> Surface:
    srgb = random.choice([0.1, 0.4, 0.9], (random.integers(30, 80), 3))
    shares = random.uniform(0.1, 3.0, len(srgb))
    return srgb_to_lab(srgb), shares / shares.sum()


def histogram(lab: FloatArray, shares: FloatArray) -> FloatArray:
    return join_bins(lab_histogram(lab, *BINS, shares), *CELLS)


@given(SEEDS, st.sampled_from([0.0, 0.3, 2.0]))
@settings(max_examples=40)
def test_the_words_of_two_surfaces_share_out_the_distance_of_their_bags(seed: int, softness: float) -> None:
    random = np.random.default_rng(seed)
    words = random.standard_normal((9, 3))
    one, other = surface(random, 3), surface(random, 3)
    gap = bag_of_features(*one, words, softness) - bag_of_features(*other, words, softness)
    here = word_densities(*one, words, softness, np.maximum(gap, 0))
    there = word_densities(*other, words, softness, np.maximum(-gap, 0))
    assert here.min() >= 0
    assert there.min() >= 0
    assert here.max() <= 1 + 1e-9  # no point adds more than all of it
    assert one[1] @ here + other[1] @ there == pytest.approx(np.abs(gap).sum())


def test_a_word_that_no_point_belongs_to_has_no_place() -> None:
    points, words = np.zeros((4, 1)), np.array([[0.0], [9.0]])
    placed = word_densities(points, np.full(4, 0.25), words, 0.0, np.array([0.25, 0.5]))
    np.testing.assert_allclose(placed, 0.25)


def test_only_points_of_a_word_that_is_surplus_are_marked() -> None:
    points, words = np.array([[0.0], [0.0], [9.0], [9.0]]), np.array([[0.0], [9.0]])
    shares = np.array([0.1, 0.3, 0.3, 0.3])
    placed = word_densities(points, shares, words, 0.0, np.array([0.2, 0.0]))
    np.testing.assert_allclose(placed, [0.5, 0.5, 0.0, 0.0])


@given(SEEDS)
@settings(max_examples=20)
def test_the_colours_of_two_surfaces_share_out_the_distance_of_their_histograms(seed: int) -> None:
    random = np.random.default_rng(seed)
    one, other = coloured(random), coloured(random)
    held, its = histogram(*one), histogram(*other)
    here = cell_densities(*one, held, np.maximum(held - its, 0), PARAMETERS)
    there = cell_densities(*other, its, np.maximum(its - held, 0), PARAMETERS)
    assert min(here.min(), there.min()) >= 0
    assert one[1] @ here + other[1] @ there == pytest.approx(np.abs(held - its).sum())


def test_colours_that_no_point_has_have_no_place() -> None:
    grey, red = (srgb_to_lab(np.tile([colour], (50, 1))) for colour in ([0.5, 0.5, 0.5], [0.9, 0.1, 0.1]))
    shares = np.full(50, 0.02)
    fine = 0.5 * histogram(grey, shares) + 0.5 * histogram(red, shares)  # half of the texels are red
    surplus = np.maximum(fine - histogram(grey, shares), 0)
    assert shares @ cell_densities(grey, shares, fine, surplus, PARAMETERS) < 0.01 * surplus.sum()


def test_of_colours_that_few_points_have_only_their_part_is_placed() -> None:
    grey, red = srgb_to_lab(np.array([[0.5, 0.5, 0.5], [0.9, 0.1, 0.1]]))
    lab, shares = np.vstack([np.tile(grey, (49, 1)), red]), np.full(50, 0.02)
    held = 0.5 * histogram(lab[:1], np.ones(1)) + 0.5 * histogram(lab[-1:], np.ones(1))  # half of the texels
    placed = cell_densities(
        lab, shares, held, np.maximum(held - histogram(lab[:1], np.ones(1)), 0), PARAMETERS
    )
    assert shares @ placed == pytest.approx(0.02, rel=0.01)  # of a half: what the red point stands for
    assert placed[-1] == pytest.approx(1.0, rel=0.01)


@given(SEEDS)
@settings(max_examples=40)
def test_all_that_curves_differ_by_is_placed(seed: int) -> None:
    random = np.random.default_rng(seed)
    orders, shares = surface(random, 3)
    lab = random.uniform(0, 90, (len(shares), 3))
    own = colour_curves(orders, lab, shares, 16)
    placed = curve_densities(orders, lab, shares, own, random.uniform(0, 90, own.shape), 5.0)
    assert placed.min() >= 0
    assert shares @ placed == pytest.approx(5.0)


def test_what_curves_differ_by_without_a_gap_lies_everywhere_alike() -> None:
    orders, shares = surface(np.random.default_rng(0), 3)
    lab = np.full((len(shares), 3), 40.0)
    own = colour_curves(orders, lab, shares, 16)
    np.testing.assert_allclose(curve_densities(orders, lab, shares, own, own, 3.0), 3.0)


def test_a_part_of_another_colour_is_where_curves_differ_on_both_surfaces() -> None:
    random = np.random.default_rng(1)
    heat = random.permutation(2000) / 2000
    orders = np.column_stack([heat, heat**2, random.uniform(0, 1, 2000)])
    shares = np.full(2000, 1 / 2000)
    lab = np.column_stack([40 + 30 * (heat > 0.5), 10 * np.sin(20 * heat), np.zeros(2000)])
    part = heat >= 14 / 16
    painted = np.where(part[:, None], [50.0, 60.0, 40.0], lab)
    curves = [colour_curves(orders, colours, shares, 16) for colours in (lab, painted)]
    for colours, own, other in ((lab, *curves), (painted, *curves[::-1])):
        placed = curve_densities(orders, colours, shares, own, other, 1.0)
        assert (shares * placed)[part].sum() > 0.9


def test_what_shares_a_bin_with_another_part_in_one_order_alone_is_not_blamed() -> None:
    heat = np.arange(2000) / 2000
    orders = np.column_stack([heat, heat**2, heat % 0.5])
    shares, lab = np.full(2000, 1 / 2000), np.full((2000, 3), 40.0)
    part, beside = heat >= 14 / 16, (heat >= 6 / 16) & (heat < 8 / 16)
    painted = np.where(part[:, None], [50.0, 60.0, 40.0], lab)
    own, other = (colour_curves(orders, colours, shares, 16) for colours in (lab, painted))
    masses = shares * curve_densities(orders, lab, shares, own, other, 1.0)
    assert masses[part].sum() == pytest.approx(1.0)
    assert masses[beside].sum() == pytest.approx(0.0)
