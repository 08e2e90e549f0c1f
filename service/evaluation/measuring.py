"""From described meshes to distances, by the formula of each method."""

from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.distance import cdist

from index.methods import Method
from index.packing import rounded
from service.evaluation.cache import Cache, Described
from service.evaluation.outcome import Outcome, Question
from service.evaluation.registering import Additions, additions_of
from service.evaluation.suites import Entry, Suite
from worker.arrays import FloatArray


class GalleryRefused(Exception):
    """A model's own rest pose cannot be described, so that nothing can find it."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Loaded:
    """A test with the blocks of all its meshes."""

    suite: Suite
    entries: tuple[Entry, ...]  # of the gallery, but for refused clutter
    shapes: tuple[Described, ...]  # the same
    queries: tuple[Described, ...]

    def firsts(self, method: Method, first_stage: FloatArray) -> Iterator[tuple[int, list[int]]]:
        """Yield for each query that has blocks the gallery entries that are compared again."""
        for place, described in enumerate(self.queries):
            if described.refused is None:
                nearest = np.argsort(first_stage[place], kind="stable")
                yield place, nearest[: method.refined].tolist()


def load(suite: Suite, cache: Cache) -> Loaded:
    """Read what was described, as an index compares it; refused clutter is left out of the gallery.

    Raises
    ------
    GalleryRefused
    """
    loaded = [(entry, as_compared(cache.load(entry.recipe))) for entry in suite.gallery]
    wanted = {query.model for query in suite.queries}
    for entry, described in loaded:
        if described.refused and entry.name in wanted:
            raise GalleryRefused(f"{entry.recipe.geometry.source}: {described.refused}")
    kept = [(entry, described) for entry, described in loaded if not described.refused]
    return Loaded(
        suite=suite,
        entries=tuple(entry for entry, _ in kept),
        shapes=tuple(described for _, described in kept),
        queries=tuple(as_compared(cache.load(query.recipe)) for query in suite.queries),
    )


def as_compared(described: Described) -> Described:
    """Return a mesh with its blocks as an index keeps and compares them."""
    blocks = {name: rounded(name, block) for name, block in described.blocks.items()}
    return replace(described, blocks=blocks)


def measure(pool: Executor, loaded: Loaded, methods: Sequence[Method], additions: Additions) -> Outcome:
    """Compare every query of a test with its whole gallery.

    Parameters
    ----------
    pool : Executor
        Where shapes are registered.
    loaded : Loaded
    methods : sequence of Method
    additions : dict
        What registration added to distances in earlier tests; what this one finds is put in, too.

    Returns
    -------
    Outcome
        A refused query lies infinitely far from everything.
    """
    distances = {}
    for method in methods:
        distances[method.name] = first_stage(method, loaded.queries, loaded.shapes)
        if method.refined:
            _refine(pool, loaded, method, distances[method.name], additions)
    suite = loaded.suite
    return Outcome(
        test=suite.test,
        title=suite.title,
        explanation=suite.explanation,
        questions=tuple(
            Question(
                name=query.name,
                model=query.model,
                transformation=query.transformation,
                strength=query.strength,
            )
            for query in suite.queries
        ),
        gallery=tuple(entry.name for entry in loaded.entries),
        distances=distances,
    )


def first_stage(method: Method, queries: Sequence[Described], shapes: Sequence[Described]) -> FloatArray:
    """Return Σ_b w_b ‖x_b − y_b‖₁^p of every query to every shape, by the formula; (q, g)."""
    answered = [place for place, query in enumerate(queries) if query.refused is None]
    total = np.full((len(queries), len(shapes)), np.inf)
    if not answered:
        return total
    total[answered] = sum(
        block.weight
        * cdist(
            np.stack([queries[place].blocks[block.name] for place in answered]).astype(np.float64),
            np.stack([shape.blocks[block.name] for shape in shapes]).astype(np.float64),
            "cityblock",
        )
        ** block.power
        for block in method.blocks
    )
    return total


def _refine(
    pool: Executor, loaded: Loaded, method: Method, distances: FloatArray, additions: Additions
) -> None:
    """Add to the first of each row what registration finds, and to the others the worst of that."""
    firsts = dict(loaded.firsts(method, distances))
    pairs = {place: [loaded.entries[k].recipe for k in near] for place, near in firsts.items()}
    recipes = {place: loaded.suite.queries[place].recipe for place in firsts}
    wanted = {recipes[place]: (loaded.queries[place], pairs[place]) for place in firsts}
    shapes = {entry.recipe: shape for entry, shape in zip(loaded.entries, loaded.shapes, strict=True)}
    additions_of(pool, wanted, shapes, additions)
    for place, near in firsts.items():
        added = np.array([additions[recipes[place], recipe] for recipe in pairs[place]])
        distances[place] += added.max()
        distances[place, near] += added - added.max()
