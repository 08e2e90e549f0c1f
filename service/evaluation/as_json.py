"""The scores of an evaluation as one JSON document, for programs."""

from collections.abc import Mapping, Sequence
from typing import Any

from service.evaluation.outcome import Outcome
from service.evaluation.scores import Scores, score

VERSION = 1  # raised when a key changes its meaning
PER_CENT = 2  # decimals of a percentage
SHARE = 4  # decimals of a number in 0…1


def as_document(outcomes: Sequence[Outcome], settings: Mapping[str, Any]) -> dict[str, Any]:
    """Return what `json.dumps` takes.

    Parameters
    ----------
    settings : mapping
        How it was measured; kept as it is. Without a time in it the same numbers give the same document.
    """
    return {"version": VERSION, "tests": [_test(outcome) for outcome in outcomes], "settings": dict(settings)}


def _test(outcome: Outcome) -> dict[str, Any]:
    return {
        "test": outcome.test,
        "title": outcome.title,
        "questions": len(outcome.questions),
        "gallery": len(outcome.gallery),
        "methods": {method: _method(scores) for method, scores in score(outcome).items()},
    }


def _method(scores: Scores) -> dict[str, Any]:
    return {
        "map": {row: [_per_cent(value) for value in values] for row, values in scores.mean_precision.items()},
        "success": {str(k): _per_cent(value) for k, value in scores.success.items()},
        "precision_recall": [
            [round(float(recall), SHARE), round(float(precision), SHARE)]
            for recall, precision in scores.precision_recall
        ],
    }


def _per_cent(value: float | None) -> float | None:
    return None if value is None else round(value, PER_CENT)
