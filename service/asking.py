"""Asking: which shapes lie nearest to a query, by a method and its second stage."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial

from index.errors import BadBlock, FileMissing, VocabularyChanged
from index.methods import DEFAULT_METHOD, method, with_weights
from index.searcher import Searcher
from index.watch import stage
from service.library import Library
from service.quantisation import quantise, require_same
from service.refining import LANDMARKS, QUERY_LADDER, QueryLandmarks, Ranked, refine
from service.storage import load_signature
from service.vocabularies import check_not_behind, known_vocabulary, own_vocabulary
from worker.arrays import SingleArray
from worker.describe import Description

REFINE = "refine"  # the stage of a query after those of `index.searcher`
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
    partly: bool = False  # whether only shapes were looked at that are described anew already
    exact: bool = True  # whether no shape can be missing


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
    query = _StoredQuery(library, shape_id, question)
    return _rank(library, question, query, query.landmarks, (shape_id,))


def near_without_refining(library: Library, shape_id: str, question: Question) -> list[str]:
    """Return the ids of the shapes that the blocks alone bring nearest to a stored one.

    Raises
    ------
    ShapeNotFound, NotReady, UnknownMethod, BadWeights
    """
    query = _StoredQuery(library, shape_id, question)
    found = _until_settled(lambda: _search(library, question, query, question.limit, (shape_id,)))
    return [near for near, _ in found.ranked]


def rank_description(library: Library, description: Description, question: Question) -> Found:
    """Return the shapes that lie nearest to a description."""

    def query() -> tuple[str, Blocks]:
        vocabulary = own_vocabulary(library)
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


class _StoredQuery:
    """A stored shape as a query: its blocks, and the landmarks by which it is registered with others."""

    def __init__(self, library: Library, shape_id: str, question: Question) -> None:
        self._library, self._shape_id = library, shape_id
        self._names = {LANDMARKS, *(block.name for block in method(question.method).blocks)}
        self._made_in: str | None = None  # where the files lie that belong to the blocks

    def __call__(self) -> tuple[str, Blocks]:
        """Return a vocabulary's id, and the blocks in its words."""
        stored = self._library.catalogue.query_blocks(self._shape_id, self._names)
        vocabulary_id = known_vocabulary(stored.vocabulary_id)
        check_not_behind(self._library, vocabulary_id)
        self._made_in = stored.made_in
        return vocabulary_id, stored.blocks

    def landmarks(self, blocks: Blocks) -> QueryLandmarks:
        """Join the landmarks and what is kept for queries alone.

        Raises
        ------
        ShapeNotFound
            The shape was removed in this moment.
        VocabularyChanged
            All shapes have been described anew in this moment.
        BadBlock
            It was described by an early version.
        """
        packed = blocks.get(LANDMARKS)
        if packed is None:
            raise BadBlock("this shape was described without landmarks; index its files anew")
        try:
            ladder = load_signature(self._library.files, self._shape_id, QUERY_LADDER, self._made_in)
        except FileMissing:
            if self._library.catalogue.get(self._shape_id).made_in != self._made_in:
                raise VocabularyChanged("all shapes have been described anew in this moment") from None
            raise
        return QueryLandmarks(packed=packed, ladder=ladder)


def _rank(
    library: Library,
    question: Question,
    query: AsQuery,
    landmarks: Callable[[Blocks], QueryLandmarks],
    exclude: tuple[str, ...] = (),
) -> Found:
    """Search, and refine the first where the method does; own weights ask for the blocks alone."""
    first = question.refined

    def once() -> Found:
        found = _search(library, question, query, max(question.limit, first), exclude)
        near = tuple(shape_id for shape_id, _ in found.ranked[:first])
        ranked = found.ranked
        if near:
            with stage(REFINE, question.method):
                own = landmarks(found.blocks)  # before the others': those tell whether all is of one moment
                stored = library.catalogue.one_block(near, LANDMARKS, found.vocabulary_id)
                ranked = refine(ranked, own, stored, first)
        shown = {shape_id for shape_id, _ in ranked[: question.limit]}
        registered = tuple(shape_id for shape_id in near if shape_id in shown)
        return replace(found, ranked=ranked[: question.limit], registered=registered)

    return _until_settled(once)


def _search(
    library: Library, question: Question, query: AsQuery, limit: int, exclude: tuple[str, ...]
) -> Found:
    """Search with the vocabulary that the query is in."""
    vocabulary_id, blocks = query()
    search = partial(
        Searcher.search,
        method_name=question.method,
        query_blocks=blocks,
        limit=limit,
        weights=question.weights,
        exclude=exclude,
        vocabulary_id=vocabulary_id,
    )
    try:
        ranked, used = search(library.searcher), library.searcher
    except VocabularyChanged:
        if library.catalogue.state().next_vocabulary_id != vocabulary_id:
            raise
        ranked, used = search(library.upcoming), library.upcoming
    if library.upcoming.loaded and library.catalogue.state().next_vocabulary_id is None:
        library.upcoming.forget()  # its shapes are in the other index now
    return Found(
        ranked=ranked,
        registered=(),
        blocks=blocks,
        vocabulary_id=vocabulary_id,
        partly=used is library.upcoming,
        exact=used.proves(question.method, limit, question.weights),
    )


def _until_settled(ask: Callable[[], Found]) -> Found:
    """Ask again where another vocabulary becomes active in this moment."""
    for _ in range(ATTEMPTS):
        try:
            return ask()
        except VocabularyChanged:
            continue
    raise VocabularyChanged("vocabularies kept changing during the query; try again")
