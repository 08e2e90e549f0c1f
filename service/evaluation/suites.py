"""The tests of an evaluation: the paper's, and harder ones."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from service.evaluation.folder import Folder, Model
from service.evaluation.protocol import Geometry, Query, Recipe, combined_queries, paper_queries
from service.evaluation.sources import MADE

TWINS = 2  # of each model, in other colours
SWAPPED = 500  # twins in all, in the test of many
MADE_SHAPES = 1_000  # shapes made by code, in the test of a larger library


@dataclass(frozen=True, kw_only=True)
class Entry:
    """One shape of a gallery."""

    name: str  # unique
    recipe: Recipe


@dataclass(frozen=True, kw_only=True)
class Suite:
    """One test: queries, and the gallery in which they must find their model."""

    test: str  # stable name
    title: str  # for people
    explanation: str  # one or two sentences
    queries: tuple[Query, ...]
    gallery: tuple[Entry, ...]

    def recipes(self) -> Iterator[Recipe]:
        """Yield how each of its meshes is made."""
        yield from (entry.recipe for entry in self.gallery)
        yield from (query.recipe for query in self.queries)


def suites(folder: Folder, *, twins: bool, hard: bool) -> list[Suite]:
    """Return the paper's test; with ``twins`` those at little more cost; with ``hard`` the long ones too."""
    queries = tuple(paper_queries(folder.models))
    gallery = null_shapes(folder)
    tests = [
        Suite(
            test="paper",
            title="The paper's protocol",
            explanation="Each shape, changed in eleven ways at five strengths, must find its rest pose.",
            queries=queries,
            gallery=gallery,
        )
    ]
    if twins or hard:
        tests += _near_tests(folder, queries, gallery)
    if hard:
        tests += _far_tests(folder, queries, gallery)
    return tests


def null_shapes(folder: Folder) -> tuple[Entry, ...]:
    """Return the rest poses and the clutter."""
    rests = [Entry(name=model.name, recipe=Recipe(geometry=_rest(model))) for model in folder.models]
    clutter = [
        Entry(name=source, recipe=Recipe(geometry=Geometry(model=source, source=source)))
        for source in folder.clutter
    ]
    return (*rests, *clutter)


def _near_tests(folder: Folder, queries: tuple[Query, ...], gallery: tuple[Entry, ...]) -> Iterator[Suite]:
    yield Suite(
        test="twins",
        title="Recoloured twins",
        explanation=f"Every shape is also there in {TWINS} other colourings: geometry cannot tell them.",
        queries=queries,
        gallery=(*gallery, *twins_of(folder.models, TWINS)),
    )
    yield Suite(
        test="combined",
        title="Damage and two changes of light at once",
        explanation="Another pose with holes and welds, or a cut or foreign body, and two changes of light.",
        queries=tuple(combined_queries(folder.models)),
        gallery=gallery,
    )


def _far_tests(folder: Folder, queries: tuple[Query, ...], gallery: tuple[Entry, ...]) -> Iterator[Suite]:
    each = -(-SWAPPED // len(folder.models))
    yield Suite(
        test="swapped",
        title="Five hundred recoloured copies",
        explanation=f"Every shape is also there in {each} other colourings.",
        queries=queries,
        gallery=(*gallery, *twins_of(folder.models, each)),
    )
    made = [Entry(name=f"{MADE}{k}", recipe=Recipe(geometry=_made(k))) for k in range(MADE_SHAPES)]
    yield Suite(
        test="large",
        title="A larger library",
        explanation=f"The paper's queries among {MADE_SHAPES} more shapes, made by code.",
        queries=queries,
        gallery=(*gallery, *made),
    )


def twins_of(models: Sequence[Model], count: int) -> list[Entry]:
    """Return each model in other coats."""
    return [
        Entry(name=f"{model.name} (twin {coat})", recipe=Recipe(geometry=_rest(model), coat=coat))
        for model in models
        for coat in range(count)
    ]


def _rest(model: Model) -> Geometry:
    return Geometry(model=model.name, source=model.rest)


def _made(number: int) -> Geometry:
    return Geometry(model=f"{MADE}{number}", source=f"{MADE}{number}")
