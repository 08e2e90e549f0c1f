"""Asking: which shapes lie nearest to a query, by a method and its second stage."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from index.errors import FileMissing, FingerprintMismatch, VocabularyChanged
from index.methods import DEFAULT_METHOD, method, with_weights
from service.library import Library
from service.quantisation import quantise, require_same
from service.refining import LANDMARKS, QUERY_LADDER, QueryLandmarks, Ranked, refine
from service.storage import load_signature
from service.vocabularies import active_vocabulary, known_vocabulary
from worker.arrays import SingleArray
from worker.describe import Description

ATTEMPTS = 5  # at a query while vocabularies change

Blocks = Mapping[str, SingleArray]
AsQuery = Callable[[], tuple[str, Blocks]]  # a vocabulary's id, blocks in its words


@dataclass(frozen=True, kw_only=True)
class Question:
    """How to search."""

    method: str = DEFAULT_METHOD  # a row of the table of methods
    limit: int = 10  # results at most
    weights: Mapping[str, float] | None = None  # block → weight in place of the method's own
    relations: bool = False  # whether to tell what each result is to the query, which takes longer

    @property
    def refined(self) -> int:
        """How many of the first are registered: none where own weights ask for the blocks alone."""
        return 0 if self.weights else method(self.method).refined


@dataclass(frozen=True, kw_only=True, eq=False)
class Found:
    """What lies nearest to a query."""

    ranked: Ranked  # ids and distances, nearest first
    registered: tuple[str, ...]  # ids of those that were compared a second time, more closely
    blocks: Blocks  # of the query
    vocabulary_id: str  # whose words they are in
    exact: bool  # whether no shape can be missing


def check_question(question: Question) -> None:
    """Refuse an unknown method or bad weights before anything is computed."""
    chosen = method(question.method)
    if question.weights is not None:
        with_weights(chosen, question.weights)


def rank_near(library: Library, shape_id: str, question: Question) -> Found:
    """Return the other shapes that lie nearest to a stored one.

    Raises
    ------
    ShapeNotFound, NotReady, UnknownMethod, BadWeights
    """

    def landmarks(blocks: Blocks) -> QueryLandmarks:
        return _stored_landmarks(library, shape_id, blocks)

    return _rank(library, question, _stored_query(library, shape_id, question), landmarks, (shape_id,))


def near_without_refining(library: Library, shape_id: str, question: Question) -> list[str]:
    """Return the ids of the shapes that the blocks alone bring nearest to a stored one.

    Raises
    ------
    ShapeNotFound, NotReady, UnknownMethod, BadWeights
    """
    query = _stored_query(library, shape_id, question)
    ranked, _, _ = _search(library, question, query, question.limit, (shape_id,))
    return [found for found, _ in ranked]


def rank_description(library: Library, description: Description, question: Question) -> Found:
    """Return the shapes that lie nearest to a description."""

    def query() -> tuple[str, Blocks]:
        vocabulary = active_vocabulary(library)
        require_same(description.fingerprint, vocabulary)
        return vocabulary.id, {**description.blocks, **quantise(description.signatures, vocabulary)}

    return rank_query(library, query, description.signatures[QUERY_LADDER], question)


def rank_query(library: Library, query: AsQuery, ladder: SingleArray, question: Question) -> Found:
    """Return the shapes that lie nearest to blocks that belong to no stored shape.

    Parameters
    ----------
    query : callable
        Returns a vocabulary's id and all blocks, in its words; asked again where another becomes active.
    ladder : (p, j) array
        The signature by which the query is registered.
    """

    def landmarks(blocks: Blocks) -> QueryLandmarks:
        return QueryLandmarks(packed=blocks[LANDMARKS], ladder=ladder)

    return _rank(library, question, query, landmarks)


def _stored_query(library: Library, shape_id: str, question: Question) -> AsQuery:
    names = {LANDMARKS, *(block.name for block in method(question.method).blocks)}

    def query() -> tuple[str, Blocks]:
        stored = library.catalogue.query_blocks(shape_id, names)
        return known_vocabulary(stored.vocabulary_id), stored.blocks

    return query


def _rank(
    library: Library,
    question: Question,
    query: AsQuery,
    landmarks: Callable[[Blocks], QueryLandmarks],
    exclude: tuple[str, ...] = (),
) -> Found:
    """Search, and refine the first where the method does; own weights ask for the blocks alone."""
    first = question.refined
    wanted = max(question.limit, first)
    ranked, blocks, vocabulary_id = _search(library, question, query, wanted, exclude)
    exact = library.searcher.proves(question.method, wanted, question.weights)
    near: tuple[str, ...] = tuple(shape_id for shape_id, _ in ranked[:first])
    if near:
        stored = library.catalogue.one_block(near, LANDMARKS)
        ranked = refine(ranked, landmarks(blocks), stored, first)
    ranked = ranked[: question.limit]
    shown = {shape_id for shape_id, _ in ranked}
    registered = tuple(shape_id for shape_id in near if shape_id in shown)
    return Found(
        ranked=ranked, registered=registered, blocks=blocks, vocabulary_id=vocabulary_id, exact=exact
    )


def _stored_landmarks(library: Library, shape_id: str, blocks: Blocks) -> QueryLandmarks:
    """Join a stored query's landmarks and what is kept for queries alone.

    Raises
    ------
    ShapeNotFound
        The shape was removed in this moment.
    FingerprintMismatch
        It was described by an earlier version.
    """
    packed = blocks.get(LANDMARKS)
    if packed is None:
        raise FingerprintMismatch("This shape was described by an earlier version; index its files anew.")
    try:
        ladder = load_signature(library.files, shape_id, QUERY_LADDER)
    except FileMissing:
        library.catalogue.get(shape_id)
        raise
    return QueryLandmarks(packed=packed, ladder=ladder)


def _search(
    library: Library, question: Question, query: AsQuery, limit: int, exclude: tuple[str, ...]
) -> tuple[Ranked, Blocks, str]:
    """Search with the active vocabulary, once more where another becomes active in this moment.

    Returns
    -------
    list of (id, distance)
    mapping of str to array
        The query's blocks.
    str
        The vocabulary's id.
    """
    for _ in range(ATTEMPTS):
        vocabulary_id, blocks = query()
        try:
            found = library.searcher.search(
                question.method,
                blocks,
                limit,
                weights=question.weights,
                exclude=exclude,
                vocabulary_id=vocabulary_id,
            )
        except VocabularyChanged:
            continue
        return found, blocks, vocabulary_id
    raise VocabularyChanged("vocabularies kept changing during the query; try again")
