import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from worker.arrays import SingleArray
from worker.descriptors.colour_change import (
    CLIPPED,
    CONTRASTS,
    FLOOR,
    ROUNDS,
    SATURATIONS,
    TRUST,
    ColourChange,
    fit_change,
)
from worker.geometry.gamut import clip_to_gamut

CHANGES = st.builds(
    ColourChange,
    contrast=st.floats(0.8, 1.3),
    offset=st.floats(-5.0, 5.0),
    saturation=st.floats(0.2, 1.2),
    tint=st.tuples(st.floats(-5.0, 5.0), st.floats(-5.0, 5.0)),
)  # none takes the muted colours out of sRGB
MODULE = "worker.descriptors.colour_change"


def muted(n: int = 200) -> SingleArray:
    """Return colours (3, n) around a middle grey."""
    lab = np.random.default_rng(0).uniform([40, -9, -9], [60, 9, 9], (n, 3))
    return np.ascontiguousarray(lab.T, np.float32)


def numbers(change: ColourChange) -> list[float]:
    """Return factors in hundredths and shifts in Lab units: about as visible."""
    return [100 * change.contrast, 100 * change.saturation, change.offset, *change.tint]


def slowly(before: SingleArray, after: SingleArray, weights: SingleArray) -> ColourChange:
    """Fit by the definition: weighted ridge regression again and again, in double precision."""
    in_light, in_chroma = weights, weights
    for _ in range(ROUNDS):
        contrast, offset = line(before[:1], after[:1], in_light, CONTRASTS)
        saturation, tint = line(before[1:], after[1:], in_chroma, SATURATIONS)
        change = ColourChange(
            contrast=contrast, offset=offset[0], saturation=saturation, tint=(tint[0], tint[1])
        )
        clipped, outside = clip_to_gamut(change.unclipped(before))
        trusted = np.where(outside, CLIPPED * weights, weights)
        light, a, b = clipped - after
        in_light, in_chroma = trusted / (np.abs(light) + FLOOR), trusted / (np.hypot(a, b) + FLOOR)
    return change


def line(
    before: SingleArray, after: SingleArray, weights: SingleArray, limits: tuple[float, float]
) -> tuple[float, list[float]]:
    """Return factor and shifts of rows with one factor, which is pulled to 1."""
    means, targets = (np.average(rows.astype(float), axis=1, weights=weights) for rows in (before, after))
    covariance = np.average(((before - means[:, None]) * (after - targets[:, None])).sum(0), weights=weights)
    variance = np.average(((before - means[:, None]) ** 2).sum(0), weights=weights)
    factor = float(np.clip((covariance + TRUST) / (variance + TRUST), *limits))
    return factor, (targets - factor * means).tolist()


@given(st.integers(0, 1000), st.floats(1.0, 40.0))
def test_it_is_what_the_definition_says(seed: int, spread: float) -> None:
    random = np.random.default_rng(seed)
    before, after = random.normal([[60.0], [0.0], [0.0]], spread, (2, 3, 100)).astype(np.float32)
    after = 0.5 * (before + after)
    weights = random.uniform(0.0, 1.0, 100).astype(np.float32)
    found = numbers(fit_change(before, after, weights))
    np.testing.assert_allclose(found, numbers(slowly(before, after, weights)), rtol=1e-3, atol=1e-3)


def test_no_change_leaves_colours_as_they_are() -> None:
    np.testing.assert_array_equal(ColourChange().apply(muted()), muted())


@given(CHANGES)
def test_a_change_is_affine_where_srgb_holds_the_result(change: ColourChange) -> None:
    lightness, a, b = muted().astype(np.float64)
    expected = [
        change.contrast * lightness + change.offset,
        change.saturation * a + change.tint[0],
        change.saturation * b + change.tint[1],
    ]
    np.testing.assert_allclose(change.apply(muted()), expected, atol=1e-4)


def test_a_change_clips_what_srgb_cannot_hold() -> None:
    change = ColourChange(offset=60.0, tint=(90.0, 0.0))
    assert clip_to_gamut(change.unclipped(muted()))[1].all()
    assert not clip_to_gamut(change.apply(muted()))[1].any()


@given(CHANGES)
def test_a_known_change_is_found_in_clean_pairs_exactly_but_for_the_pull_to_1(change: ColourChange) -> None:
    before = muted()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(f"{MODULE}.TRUST", 0.0)
        found = fit_change(before, change.apply(before), np.ones(200, np.float32))
    np.testing.assert_allclose(numbers(found), numbers(change), atol=2e-3)


def test_one_round_is_the_closed_form_of_ridge_regression(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(f"{MODULE}.ROUNDS", 1)
    before = muted()[:, :100]
    after = 0.6 * before + 0.4 * muted()[:, 100:]
    weights = np.random.default_rng(1).uniform(0.1, 3.0, 100).astype(np.float32)
    found = fit_change(before, after, weights)
    covariances = np.cov(np.vstack([before, after]), aweights=weights, ddof=0)  # (6, 6)
    alone, common = np.diag(covariances), np.diag(covariances, 3)
    assert found.contrast == pytest.approx((common[0] + TRUST) / (alone[0] + TRUST), rel=1e-5)
    assert found.saturation == pytest.approx(
        (common[1:].sum() + TRUST) / (alone[1:3].sum() + TRUST), rel=1e-5
    )
    mean, target = (np.average(lab, axis=1, weights=weights) for lab in (before, after))
    np.testing.assert_allclose(found.unclipped(mean[:, None])[:, 0], target, atol=1e-3)


@given(CHANGES, st.integers(0, 1000))
def test_a_fifth_of_wrong_pairs_hardly_matters(change: ColourChange, seed: int) -> None:
    random = np.random.default_rng(seed)
    before, after = muted(), change.apply(muted())
    wrong = random.permutation(200)[:40]
    after[:, wrong] = np.array([[90.0], [30.0], [40.0]]) + random.normal(0.0, 5.0, (3, 40))

    def error() -> float:
        found = fit_change(before, after, np.ones(200, np.float32))
        return float(np.abs(found.unclipped(before) - change.unclipped(before)).mean())

    deviations = error()
    assert deviations < 1.0  # Lab units: too little to be seen
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(f"{MODULE}.ROUNDS", 1)  # least squares
        assert error() > 5 * deviations


@pytest.mark.parametrize("offset", [-20.0, 20.0])
def test_clipping_hides_little_of_a_change(offset: float, monkeypatch: pytest.MonkeyPatch) -> None:
    lab = np.random.default_rng(0).uniform([5, -10, -10], [95, 10, 10], (400, 3))
    before, change = lab.T.astype(np.float32), ColourChange(offset=offset)
    held = ~clip_to_gamut(change.unclipped(before))[1]
    assert 0.7 < held.mean() < 0.85

    def error() -> float:
        found = fit_change(before, change.apply(before), np.ones(400, np.float32))
        return float(np.abs(found.unclipped(before) - change.unclipped(before))[:, held].mean())

    doubting = error()
    assert doubting < 0.3  # Lab units
    monkeypatch.setattr(f"{MODULE}.CLIPPED", np.float32(1.0))
    assert error() > 4 * doubting


@given(st.floats(-20.0, 20.0), st.floats(-20.0, 20.0), st.integers(0, 1000))
def test_factors_stay_in_their_ranges(light: float, chroma: float, seed: int) -> None:
    factors = np.array([[light], [chroma], [chroma]], np.float32)
    before = np.random.default_rng(seed).normal(0.0, 30.0, (3, 50)).astype(np.float32)
    found = fit_change(before, factors * before, np.ones(50, np.float32))
    assert CONTRASTS[0] <= found.contrast <= CONTRASTS[1]
    assert SATURATIONS[0] <= found.saturation <= SATURATIONS[1]


def test_one_colour_says_nothing_about_factors() -> None:
    before, after = np.full((3, 9), 40.0, np.float32), muted(9)
    after[:] = after[:, :1]
    found = fit_change(before, after, np.ones(9, np.float32))
    assert (found.contrast, found.saturation) == pytest.approx((1.0, 1.0), abs=1e-9)
    np.testing.assert_allclose([found.offset, *found.tint], after[:, 0] - 40.0, atol=1e-4)


def test_pairs_without_weight_do_not_count() -> None:
    before, weights = muted(), np.ones(200, np.float32)
    after = ColourChange(contrast=0.8, tint=(5.0, -3.0)).apply(before)
    weights[150:], after[:, 150:] = 0.0, 99.0
    alone = fit_change(before[:, :150], after[:, :150], weights[:150])
    np.testing.assert_allclose(numbers(fit_change(before, after, weights)), numbers(alone), atol=1e-6)
    assert fit_change(before, after, 0 * weights) == ColourChange()


def test_no_change_is_not_unusual_at_all() -> None:
    assert ColourChange().unusual() == 0.0


@given(CHANGES)
def test_each_step_away_is_more_unusual(change: ColourChange) -> None:
    steps = [
        ColourChange(contrast=change.contrast),
        ColourChange(contrast=change.contrast, offset=change.offset),
        ColourChange(contrast=change.contrast, offset=change.offset, saturation=change.saturation),
        change,
    ]
    unusual = [step.unusual() for step in steps]
    assert unusual == sorted(unusual)
    assert unusual[0] == pytest.approx(ColourChange(contrast=1.0 / change.contrast).unusual())
    twice = ColourChange(offset=2 * change.offset, tint=(2 * change.tint[0], 2 * change.tint[1]))
    once = ColourChange(offset=change.offset, tint=change.tint)
    assert twice.unusual() == pytest.approx(2 * once.unusual())
