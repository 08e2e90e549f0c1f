from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from service.evaluation.scores import (
    best_method,
    mean_average_precision,
    precision_recall,
    ranked,
    ranks_of,
    rows_of,
    score,
)
from tests.outcomes import outcome
from worker.arrays import FloatArray, IntArray


def random_distances(seed: int, questions: int = 12, gallery: int = 7) -> tuple[FloatArray, IntArray]:
    random = np.random.default_rng(seed)
    return random.integers(0, 6, (questions, gallery)).astype(float), random.integers(0, gallery, questions)


def harmonic(n: int) -> float:
    return float(np.sum(1.0 / np.arange(1, n + 1)))


def test_ranks_are_those_that_the_distances_were_made_for() -> None:
    told = [1, 3, 8, 2]
    assert score(outcome({"method": told}))["method"].ranks.tolist() == told


def test_precision_is_the_mean_of_one_over_the_rank() -> None:
    scores = score(outcome({"method": [1, 2, 4, 5]}))["method"]
    hue, partiality = (1 / 1 + 1 / 2) / 2, (1 / 4 + 1 / 5) / 2
    assert scores.mean_precision["hue"] == pytest.approx((100, 100, 100, 100, 100 * hue))
    assert scores.mean_precision["partiality"][1:] == pytest.approx(
        (25, 25, 100 * partiality, 100 * partiality)
    )
    assert scores.overall == pytest.approx(100 * (hue + partiality) / 2)


def test_a_strength_that_was_not_asked_has_no_score() -> None:
    scores = score(outcome({"method": [1, 2, 4, 5]}))["method"]
    assert scores.mean_precision["partiality"][0] is None
    assert scores.by_strength["hue"] == (100.0, None, None, None, 50.0)


def test_rows_come_in_the_order_of_first_appearance_after_all() -> None:
    assert rows_of(outcome({"method": [1, 1, 1, 1]})) == ("all", "hue", "partiality")


def test_success_is_the_share_among_the_first() -> None:
    scores = score(outcome({"method": [1, 2, 5, 12]}, gallery=20))["method"]
    assert scores.success == {1: 25.0, 5: 75.0, 10: 75.0}


def test_a_tie_with_k_wrong_answers_puts_the_right_one_behind_all_k() -> None:
    distances = np.array([[0.0, 2.0, 2.0, 2.0, 3.0]])
    assert ranks_of(distances, np.array([2])).tolist() == [4]
    assert ranks_of(np.zeros((1, 5)), np.array([0])).tolist() == [5]


def test_what_is_not_a_number_counts_against_the_right_answer() -> None:
    distances = np.array([[1.0, np.nan, 2.0], [np.nan, 1.0, 2.0]])
    assert ranks_of(distances, np.array([0, 0])).tolist() == [2, 3]


def test_a_ranking_by_chance_scores_the_harmonic_number_over_the_gallery() -> None:
    gallery = 50
    every_rank = np.arange(1, gallery + 1)
    expected = 100 * harmonic(gallery) / gallery
    assert mean_average_precision(every_rank) == pytest.approx(expected)
    questions = 20_000
    distances = np.random.default_rng(0).random((questions, gallery))
    precisions = 1.0 / ranks_of(distances, np.zeros(questions, dtype=np.int64))
    error = 100 * np.std(precisions) / np.sqrt(questions)
    assert abs(100 * np.mean(precisions) - expected) < 4 * error


@given(st.integers(0, 2**32 - 1))
def test_scores_are_between_0_and_100(seed: int) -> None:
    precision = mean_average_precision(ranks_of(*random_distances(seed)))
    assert precision is not None
    assert 100 / 7 <= precision <= 100


@given(st.integers(0, 2**32 - 1))
def test_an_increasing_function_of_the_distances_changes_nothing(seed: int) -> None:
    distances, right = random_distances(seed)
    np.testing.assert_array_equal(ranks_of(np.exp(distances), right), ranks_of(distances, right))


@given(st.integers(0, 2**32 - 1))
def test_the_order_of_the_gallery_changes_nothing(seed: int) -> None:
    distances, right = random_distances(seed)
    order = np.random.default_rng(seed).permutation(distances.shape[1])
    moved = np.argsort(order)[right]
    np.testing.assert_array_equal(ranks_of(distances[:, order], moved), ranks_of(distances, right))


@given(st.integers(0, 2**32 - 1), st.floats(0, 3))
def test_a_nearer_right_answer_never_scores_less(seed: int, nearer: float) -> None:
    distances, right = random_distances(seed)
    moved = distances.copy()
    moved[np.arange(len(right)), right] -= nearer
    assert (ranks_of(moved, right) <= ranks_of(distances, right)).all()


@given(st.integers(0, 2**32 - 1))
def test_the_shown_ranking_has_the_right_answer_at_its_rank(seed: int) -> None:
    distances, right = random_distances(seed)
    distances[np.random.default_rng(seed).random(distances.shape) < 0.1] = np.nan
    for row, place, rank in zip(distances, right, ranks_of(distances, right), strict=True):
        order = ranked(row, int(place))
        assert sorted(order) == list(range(len(row)))
        assert order[rank - 1] == place


@given(st.integers(0, 2**32 - 1))
def test_recall_and_precision_are_counts_of_the_answers(seed: int) -> None:
    ranks = ranks_of(*random_distances(seed))
    for cutoff, (recall, precision) in enumerate(precision_recall(ranks, 7), 1):
        right = sum(rank <= cutoff for rank in ranks)
        assert recall == pytest.approx(right / len(ranks))
        assert precision == pytest.approx(right / (len(ranks) * cutoff))


def test_of_equally_good_methods_the_first_is_best() -> None:
    assert best_method(score(outcome({"a": [2] * 4, "b": [1] * 4, "c": [1] * 4}))) == "b"


def test_an_outcome_that_cannot_be_scored_says_why() -> None:
    good = outcome({"method": [1, 1, 1, 1]})
    with pytest.raises(ValueError, match="lacks right answers: model 0"):
        score(replace(good, gallery=("x", *good.gallery[1:])))
    with pytest.raises(ValueError, match="different names"):
        score(replace(good, gallery=good.gallery[:-1] + good.gallery[:1]))
    with pytest.raises(ValueError, match="0 questions"):
        score(replace(good, questions=()))
    with pytest.raises(ValueError, match=r"'method' must have shape \(4, 8\), not \(8, 4\)"):
        score(replace(good, distances={"method": good.distances["method"].T}))
