"""Which queries of a test a report shows: telling ones of every kind, and what the best method gets wrong."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import cycle, islice

import numpy as np

from service.evaluation.outcome import Outcome, Question
from service.evaluation.scores import Scores, rows_of
from worker.arrays import FloatArray

STRONG = 4  # strengths from here on are shown where there are any
LEAST_CHOSEN, MOST_CHOSEN = 4, 12
MOST_FAILURES = 6


def choose_questions(outcome: Outcome, scores: Mapping[str, Scores], shown: Sequence[str]) -> list[int]:
    """Return a question for each transformation: strong, the methods at odds, of a model not yet chosen.

    Parameters
    ----------
    shown : sequence of str
        Methods whose answers stand beside each other: it matters most that these are at odds.

    Returns
    -------
    list of int
        Places in ``outcome.questions``, in the order of the rows; the same for the same scores.
    """
    interest = _at_odds([scores[method] for method in shown]) + 0.1 * _at_odds(list(scores.values()))
    rows = rows_of(outcome)[1:]
    chosen: list[int] = []
    for row in islice(cycle(rows), min(max(len(rows), LEAST_CHOSEN), MOST_CHOSEN)):
        asked = [
            k
            for k, question in enumerate(outcome.questions)
            if question.transformation == row and k not in chosen
        ]
        models = {outcome.questions[k].model for k in chosen}
        strong = [k for k in asked if outcome.questions[k].strength >= STRONG] or asked
        if strong:
            chosen.append(
                max(strong, key=lambda k: _appeal(outcome.questions[k], float(interest[k]), models))
            )
    return chosen


def choose_failures(scores: Scores, without: list[int], most: int = MOST_FAILURES) -> list[int]:
    """Return the questions that a method answers worst, the worst first; none that it answers at once."""
    failed = (k for k in _worst_first(scores) if scores.ranks[k] > 1 and k not in without)
    return [k for k, _ in zip(failed, range(most), strict=False)]


def _at_odds(scores: Sequence[Scores]) -> FloatArray:
    """Return 0, 1/2 or 1 for each question, (q,): how far the methods' average precisions are apart."""
    precisions = np.stack([1.0 / each.ranks for each in scores])  # (methods, q)
    spread: FloatArray = precisions.max(axis=0) - precisions.min(axis=0)
    return np.round(2.0 * spread) / 2.0


def _appeal(question: Question, interest: float, chosen: set[str]) -> tuple[float, bool, int]:
    return interest, question.model not in chosen, question.strength


def _worst_first(scores: Scores) -> Iterator[int]:
    return (int(k) for k in np.argsort(-scores.ranks, kind="stable"))
