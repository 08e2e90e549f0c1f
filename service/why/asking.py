"""Use cases: explain the distance of two shapes in numbers, or on their surfaces."""

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from enum import StrEnum

from index.methods import DEFAULT_METHOD, method, with_weights
from index.vocabulary import Vocabulary
from service.library import Library
from service.vocabularies import settled_vocabulary
from service.why.explaining import Explanation, explain
from service.why.placing import check_places
from service.why.scale import colours_of
from service.why.sides import Side, remembered_side, stored_side
from worker.pictures.preview import preview

AsSide = Callable[[Collection[str], Vocabulary], Side]  # names of blocks, the active vocabulary


class Which(StrEnum):
    """One of the two shapes of an explanation."""

    QUERY = "query"
    RESULT = "result"


@dataclass(frozen=True, kw_only=True)
class WhyQuestion:
    """What is to be explained."""

    method: str = DEFAULT_METHOD
    weights: Mapping[str, float] | None = None  # block → weight in place of the method's own


@dataclass(frozen=True, kw_only=True, eq=False)
class Explained:
    """An explanation with the surfaces that it is about."""

    explanation: Explanation
    query: Side
    result: Side

    def glb(self, which: Which) -> bytes:
        """Return one of the surfaces as GLB, coloured by what each vertex adds to the distance."""
        asked = which is Which.QUERY
        side, densities = (
            (self.query, self.explanation.query) if asked else (self.result, self.explanation.result)
        )
        return preview(side.vertices, side.faces, colours_of(densities, self.explanation.scale))


def explain_stored(library: Library, shape_id: str, other_id: str, question: WhyQuestion) -> Explained:
    """Explain the distance of two stored shapes.

    Raises
    ------
    ShapeNotFound, NotReady, FileMissing, BadBlock, VocabularyChanged, NoVocabulary, UnknownMethod,
    BadWeights, NotExplained
    """

    def query(names: Collection[str], vocabulary: Vocabulary) -> Side:
        return stored_side(library, shape_id, names, vocabulary)

    return _explain_near(library, query, other_id, question)


def explain_remembered(library: Library, query_id: str, other_id: str, question: WhyQuestion) -> Explained:
    """Explain the distance of a remembered query to a stored shape.

    Raises
    ------
    QueryNotFound
        And what `explain_stored` raises for the stored shape.
    """

    def query(names: Collection[str], vocabulary: Vocabulary) -> Side:
        return remembered_side(library, query_id, names, vocabulary)

    return _explain_near(library, query, other_id, question)


def _explain_near(library: Library, query: AsSide, other_id: str, question: WhyQuestion) -> Explained:
    chosen = with_weights(method(question.method), question.weights or {})
    check_places(chosen)
    vocabulary = settled_vocabulary(library)
    names = [block.name for block in chosen.blocks]
    asked, found = query(names, vocabulary), stored_side(library, other_id, names, vocabulary)
    return Explained(explanation=explain(asked, found, chosen, vocabulary), query=asked, result=found)
