from service.evaluation.outcome import Outcome
from service.evaluation.scores import score
from service.evaluation.showcase import MOST_CHOSEN, choose_failures, choose_questions
from tests.outcomes import outcome


def chosen(found: Outcome, *shown: str) -> list[tuple[str, int]]:
    places = choose_questions(found, score(found), shown or list(found.distances))
    return [(found.questions[k].transformation, found.questions[k].strength) for k in places]


def test_each_transformation_is_shown_strong_where_methods_are_at_odds() -> None:
    kinds = [(row, strength) for row in ("hue", "noise", "mixed", "partiality") for strength in range(1, 6)]
    ranks = {"a": [1] * 20, "b": [8 if strength == 4 else 1 for _, strength in kinds]}
    assert chosen(outcome(ranks, kinds)) == [("hue", 4), ("noise", 4), ("mixed", 4), ("partiality", 4)]


def test_methods_that_are_shown_count_before_others() -> None:
    kinds = [("hue", 4), ("hue", 5), ("noise", 5), ("mixed", 5), ("partiality", 5)]
    ranks = {"a": [1] * 5, "b": [8, 1, 1, 1, 1], "c": [1, 8, 1, 1, 1]}
    assert chosen(outcome(ranks, kinds), "a", "b")[0] == ("hue", 4)
    assert chosen(outcome(ranks, kinds), "a", "c")[0] == ("hue", 5)


def test_models_are_not_repeated_where_there_are_others() -> None:
    kinds = [(row, 5) for row in ("hue", "noise") for _ in range(4)]
    found = outcome({"a": [1] * 8}, kinds, gallery=4)
    models = [found.questions[k].model for k in choose_questions(found, score(found), ["a"])]
    assert len(set(models)) == len(models)


def test_a_test_of_one_transformation_still_shows_several_queries() -> None:
    assert len(chosen(outcome({"a": [1] * 6}, [("hue", k) for k in (1, 2, 3, 4, 5, 5)]))) == 4
    assert len(chosen(outcome({"a": [1, 1]}, [("hue", 1), ("hue", 2)]))) == 2


def test_there_is_a_limit() -> None:
    kinds = [(f"change {k}", 5) for k in range(30)]
    assert len(chosen(outcome({"a": [1] * 30}, kinds))) == MOST_CHOSEN


def test_failures_are_the_worst_first_and_nothing_that_is_right() -> None:
    scores = score(outcome({"a": [1, 3, 8, 2]}))["a"]
    assert choose_failures(scores, without=[]) == [2, 1, 3]
    assert choose_failures(scores, without=[2], most=1) == [1]
    assert choose_failures(score(outcome({"a": [1, 1, 1, 1]}))["a"], without=[]) == []
