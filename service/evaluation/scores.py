"""Scores of a test: mean average precision by transformation and strength, precision against recall, success.

Every question has exactly one right answer, at rank r among g, so that its average precision is 1/r.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from service.evaluation.outcome import Outcome
from worker.arrays import BoolArray, FloatArray, IntArray

ALL = "all"  # the row over every transformation
STRENGTHS = (1, 2, 3, 4, 5)
CUTOFFS = (1, 5, 10)  # answers a person looks at


@dataclass(frozen=True, kw_only=True, eq=False)
class Scores:
    """How well one method answered a test."""

    ranks: IntArray  # (q,) of the right answers, from 1
    mean_precision: Mapping[str, tuple[float | None, ...]]  # row → mAP in % at strengths ≤ 1…5
    by_strength: Mapping[str, tuple[float | None, ...]]  # row → mAP in % at strengths 1…5; None: not asked
    success: Mapping[int, float]  # k → % of questions whose right answer is among the first k
    precision_recall: FloatArray  # (g, 2) recall and precision at cutoffs 1…g, in 0…1

    @property
    def overall(self) -> float:
        """MAP over all questions, in %."""
        return mean_average_precision(self.ranks) or 0.0


def score(outcome: Outcome) -> dict[str, Scores]:
    """Return the scores of every method, in the order of the outcome.

    Raises
    ------
    ValueError
        No questions, a right answer that is not in the gallery once, or distances of another shape.
    """
    right = right_answers(outcome)
    return {
        method: _score(outcome, ranks_of(_checked(outcome, method, distances), right))
        for method, distances in outcome.distances.items()
    }


def right_answers(outcome: Outcome) -> IntArray:
    """Return the place in the gallery of each question's right answer, (q,)."""
    places = {name: place for place, name in enumerate(outcome.gallery)}
    if not outcome.questions or len(places) < len(outcome.gallery):
        raise ValueError(
            f"{outcome.test!r} needs questions and a gallery of different names; there are "
            f"{len(outcome.questions)} questions, and {len(places)} names of {len(outcome.gallery)} entries"
        )
    missing = {question.model for question in outcome.questions} - set(places)
    if missing:
        raise ValueError(f"the gallery of {outcome.test!r} lacks right answers: {', '.join(sorted(missing))}")
    return np.array([places[question.model] for question in outcome.questions], dtype=np.int64)


def ranks_of(distances: FloatArray, right: IntArray) -> IntArray:
    """Return the ranks of the right answers, ties counted against them.

    Parameters
    ----------
    distances : (q, g) float array
        The smaller the nearer. What is not a number counts against the right answer too.
    right : (q,) int array
        Columns of the right answers.

    Returns
    -------
    (q,) int array
        How many entries are not farther away than the right one, itself included: 1…g.
    """
    own = distances[np.arange(len(right)), right]  # (q,)
    ranks: IntArray = np.sum(~(distances > own[:, None]), axis=1, dtype=np.int64)
    return ranks


def ranked(distances: FloatArray, right: int) -> IntArray:
    """Return the places of a gallery as one query ranks it, (g,), nearest first and ties as in `ranks_of`."""
    is_right = np.arange(len(distances)) == right
    unknown = np.where(is_right, np.inf, -np.inf)
    return np.lexsort((is_right, np.where(np.isnan(distances), unknown, distances)))


def mean_average_precision(ranks: IntArray) -> float | None:
    """Return the mean of 1/rank in per cent; None of no ranks."""
    return float(100 * np.mean(1 / ranks)) if len(ranks) else None


def precision_recall(ranks: IntArray, gallery: int) -> FloatArray:
    """Return recall and precision at every cutoff, micro-averaged over the questions.

    With one right answer to each of q questions, the first r answers hold q R(r) right ones among q r:
    recall R(r) = |{rank ≤ r}| / q, precision R(r) / r.

    Returns
    -------
    (gallery, 2) float array
        Recall, which does not decrease, and precision, for r = 1…gallery.
    """
    cutoffs = np.arange(1, gallery + 1)
    recall = np.searchsorted(np.sort(ranks), cutoffs, side="right") / len(ranks)  # (g,)
    return np.stack([recall, recall / cutoffs], axis=1)  # (g, 2)


def rows_of(outcome: Outcome) -> tuple[str, ...]:
    """Return "all", then the transformations as they first appear."""
    return (ALL, *dict.fromkeys(question.transformation for question in outcome.questions))


def best_method(scores: Mapping[str, Scores]) -> str:
    """Return the method of the highest mAP; of several the first."""
    return max(scores, key=lambda method: scores[method].overall)


def _checked(outcome: Outcome, method: str, distances: FloatArray) -> FloatArray:
    expected = (len(outcome.questions), len(outcome.gallery))
    if distances.shape != expected:
        raise ValueError(f"distances of {method!r} must have shape {expected}, not {distances.shape}")
    return distances


def _score(outcome: Outcome, ranks: IntArray) -> Scores:
    strengths = np.array([question.strength for question in outcome.questions])  # (q,)
    rows = dict(_rows(outcome))
    return Scores(
        ranks=ranks,
        mean_precision={
            row: tuple(mean_average_precision(ranks[asked & (strengths <= s)]) for s in STRENGTHS)
            for row, asked in rows.items()
        },
        by_strength={
            row: tuple(mean_average_precision(ranks[asked & (strengths == s)]) for s in STRENGTHS)
            for row, asked in rows.items()
        },
        success={k: float(100 * np.mean(ranks <= k)) for k in CUTOFFS},
        precision_recall=precision_recall(ranks, len(outcome.gallery)),
    )


def _rows(outcome: Outcome) -> Iterable[tuple[str, BoolArray]]:
    """Yield each row with the questions that it is over, (q,)."""
    names = np.array([question.transformation for question in outcome.questions])
    for row in rows_of(outcome):
        yield row, np.ones(len(names), dtype=np.bool_) if row == ALL else names == row
