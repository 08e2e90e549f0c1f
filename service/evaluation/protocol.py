"""The paper's protocol: which queries are made of a model, and how, at five strengths.

Kovnatsky, Bronstein, Bronstein and Kimmel (2011), section 6. Everything random follows from the names of the
model, the transformation and the strength.
"""

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from service.evaluation.folder import Model
from service.evaluation.photometric import PHOTOMETRIC

VERSION = 2  # raised when the queries, or the shapes of a gallery, change
STRENGTHS = (1, 2, 3, 4, 5)
ISOMETRY, PARTIALITY, MIXED = "isometry+topology", "partiality", "mixed"
TRANSFORMATIONS = (ISOMETRY, PARTIALITY, *PHOTOMETRIC, MIXED)  # rows of the paper's tables
WHOLE, BENT, PARTIAL = "whole", "bent", "partial"  # what happens to the geometry
COMBINED = {f"{ISOMETRY}, two photometric": BENT, f"{PARTIALITY}, two photometric": PARTIAL}


@dataclass(frozen=True, kw_only=True)
class Geometry:
    """Triangles before any change of colour; several queries may share them."""

    model: str  # whose they are
    source: str  # where they are read from: see `service.evaluation.sources`
    damage: str = WHOLE  # or BENT (holes and welds), or PARTIAL (a cut, or a ball stuck on)
    strength: int = 0  # of the damage


@dataclass(frozen=True, kw_only=True)
class Recipe:
    """How a mesh of the evaluation is made."""

    geometry: Geometry
    coat: int | None = None  # number of the twin whose colours it wears
    changes: tuple[str, ...] = ()  # of light and colour, one after the other
    strength: int = 0  # of those
    label: str = ""  # what its random numbers follow from


@dataclass(frozen=True, kw_only=True)
class Query:
    """One question to the search: a model, changed."""

    model: str
    transformation: str
    strength: int
    recipe: Recipe

    @property
    def name(self) -> str:
        """Unique, and fit for people."""
        return f"{self.model}, {self.transformation} {self.strength}"


def paper_queries(models: Sequence[Model]) -> list[Query]:
    """Return the queries of the paper's tables: each transformation at each strength, of each model."""
    rows = ((transformation, _paper_damage(transformation)) for transformation in TRANSFORMATIONS)
    return [
        _query(model, row, damage, strength)
        for row, damage in rows
        for model in models
        for strength in STRENGTHS
    ]


def combined_queries(models: Sequence[Model]) -> list[Query]:
    """Return queries with damaged geometry and two changes of light and colour at once."""
    return [
        _query(model, row, damage, strength)
        for row, damage in COMBINED.items()
        for model in models
        for strength in STRENGTHS
    ]


def random_of(*names: object) -> np.random.Generator:
    """Return a generator that follows from names alone."""
    digest = hashlib.sha256("/".join(map(str, names)).encode()).digest()
    return np.random.default_rng(int.from_bytes(digest[:8]))


def _paper_damage(transformation: str) -> str:
    return {ISOMETRY: BENT, MIXED: BENT, PARTIALITY: PARTIAL}.get(transformation, WHOLE)


def _query(model: Model, row: str, damage: str, strength: int) -> Query:
    if row in PHOTOMETRIC:
        changes: tuple[str, ...] = (row,)
    else:
        changes = _two_changes(model.name, row, strength) if row == MIXED or row in COMBINED else ()
    recipe = Recipe(
        geometry=_geometry(model, damage, strength),
        changes=changes,
        strength=strength,
        label=f"{model.name}/{row}",
    )
    return Query(model=model.name, transformation=row, strength=strength, recipe=recipe)


def _geometry(model: Model, damage: str, strength: int) -> Geometry:
    bent = damage == BENT and model.others
    poses = random_of(model.name, "poses").permutation(len(model.others))
    source = model.others[poses[(strength - 1) % len(poses)]] if bent else model.rest
    return Geometry(
        model=model.name, source=source, damage=damage, strength=0 if damage == WHOLE else strength
    )


def _two_changes(model: str, row: str, strength: int) -> tuple[str, ...]:
    """Draw two changes of different kinds: not more and less contrast at once."""
    random = random_of(model, row, strength, "changes")
    kinds = sorted({change.rstrip("+-") for change in PHOTOMETRIC})
    drawn = [kinds[k] for k in random.choice(len(kinds), 2, replace=False)]
    options = [[change for change in PHOTOMETRIC if change.rstrip("+-") == kind] for kind in drawn]
    return tuple(option[random.integers(len(option))] for option in options)
