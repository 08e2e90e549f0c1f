import json
from typing import Any

from service.evaluation.as_json import as_document
from service.evaluation.scores import score
from tests.outcomes import outcome


def document(**settings: Any) -> dict[str, Any]:
    ranks = {"fused": [1, 1, 1, 2], "chks": [1, 3, 7, 8]}
    read: dict[str, Any] = json.loads(json.dumps(as_document([outcome(ranks)], settings), allow_nan=False))
    return read


def test_it_holds_the_scores_rounded() -> None:
    (test,) = document()["tests"]
    assert (test["test"], test["questions"], test["gallery"]) == ("paper", 4, 8)
    scores = score(outcome({"chks": [1, 3, 7, 8]}))["chks"]
    assert test["methods"]["chks"]["map"]["hue"] == [100.0, 100.0, 100.0, 100.0, 66.67]
    assert test["methods"]["chks"]["success"] == {"1": 25.0, "5": 50.0, "10": 100.0}
    told = test["methods"]["chks"]["precision_recall"]
    assert [[round(float(x), 4) for x in row] for row in scores.precision_recall] == told


def test_a_strength_that_was_not_asked_is_null() -> None:
    assert document()["tests"][0]["methods"]["fused"]["map"]["partiality"][0] is None


def test_it_holds_the_settings_and_nothing_that_changes_by_itself() -> None:
    assert document(folder="shapes")["settings"] == {"folder": "shapes"}
    assert document() == document()
    assert set(document()) == {"version", "tests", "settings"}
