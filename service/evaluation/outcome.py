"""What a test of the evaluation asked, and how far each answer lay: the seam of measuring and reporting."""

from collections.abc import Mapping
from dataclasses import dataclass

from worker.arrays import FloatArray


@dataclass(frozen=True, kw_only=True, eq=False)
class Question:
    """One query, which has exactly one right answer."""

    name: str  # unique in its test, e.g. "mh_01_male_cauc_casual2, hue 3"
    model: str  # the gallery entry that is right
    transformation: str  # a row of the tables, e.g. "isometry+topology", "partiality", "contrast+", "hue"
    strength: int  # 1 (weak) to 5


@dataclass(frozen=True, kw_only=True, eq=False)
class Outcome:
    """One test: all questions against one gallery by all methods."""

    test: str  # stable name, e.g. "paper", "twins", "partiality+photometric"
    title: str  # for people
    explanation: str  # one or two sentences, for people
    questions: tuple[Question, ...]  # (q,)
    gallery: tuple[str, ...]  # (g,) names
    distances: Mapping[str, FloatArray]  # method → (q, g), the smaller the nearer
