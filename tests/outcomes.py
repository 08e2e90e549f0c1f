"""Outcomes of an evaluation whose ranks are known beforehand."""

from collections.abc import Mapping, Sequence

import numpy as np

from service.evaluation.outcome import Outcome, Question
from worker.arrays import FloatArray

KINDS = (("hue", 1), ("hue", 5), ("partiality", 2), ("partiality", 4))


def outcome(
    ranks: Mapping[str, Sequence[int]],
    kinds: Sequence[tuple[str, int]] = KINDS,
    gallery: int = 8,
    test: str = "paper",
    title: str = "The paper's transformations",
) -> Outcome:
    """Return an outcome in which each method ranks the right answers as told.

    Parameters
    ----------
    ranks : mapping
        Method → rank of the right answer to each question.
    kinds : sequence of (str, int)
        Transformation and strength of each question; the n-th asks for the model n modulo ``gallery``.
    """
    names = tuple(f"model {k}" for k in range(gallery))
    questions = tuple(
        Question(
            name=f"query {k}: {kind} {strength}",
            model=names[k % gallery],
            transformation=kind,
            strength=strength,
        )
        for k, (kind, strength) in enumerate(kinds)
    )
    distances = {method: _distances(values, gallery) for method, values in ranks.items()}
    return Outcome(
        test=test,
        title=title,
        explanation="Made for a test.",
        questions=questions,
        gallery=names,
        distances=distances,
    )


def _distances(ranks: Sequence[int], gallery: int) -> FloatArray:
    """Return (q, gallery): wrong answers at 1, 2, 3, …, the right one just before that of its rank."""
    rows = []
    for place, rank in enumerate(ranks):
        row = np.arange(1.0, gallery)
        rows.append(np.insert(row, place % gallery, rank - 0.5))
    return np.array(rows)
