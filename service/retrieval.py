"""Use cases, free of HTTP: take a mesh in, change it, remove it, and find what is similar."""

import time
import uuid
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import Any

from index.errors import FileMissing, FingerprintMismatch, VocabularyChanged
from index.methods import DEFAULT_METHOD, method, with_weights
from index.shapes import Shape, Status, StoredFile
from service.intake.submissions import Submission
from service.jobs.describing import Describe, describe_files
from service.library import Library
from service.quantisation import quantise, require_same
from service.refining import LANDMARKS, QUERY_LADDER, QueryLandmarks, refine
from service.storage import load_signature, upload_key
from service.vocabularies import active_vocabulary, known_vocabulary
from worker.arrays import SingleArray
from worker.describe import Description, MeshFacts
from worker.reading.upload import inspect_upload

ATTEMPTS = 5  # at a query while vocabularies change
AsQuery = Callable[[], tuple[str, Mapping[str, SingleArray]]]  # a vocabulary's id, blocks in its words


@dataclass(frozen=True, kw_only=True)
class Question:
    """How to search."""

    method: str = DEFAULT_METHOD  # a row of the table of methods
    limit: int = 10  # results at most
    weights: Mapping[str, float] | None = None  # block → weight in place of the method's own


@dataclass(frozen=True, kw_only=True)
class Hit:
    """One result."""

    rank: int  # from 1
    distance: float  # of the method
    shape: Shape


@dataclass(frozen=True, kw_only=True)
class Answer:
    """A ranked answer."""

    method: str
    milliseconds: float  # from the question to here
    hits: tuple[Hit, ...]  # nearest first
    query: MeshFacts | None = None  # of a mesh that is not kept


def accept_upload(library: Library, submission: Submission) -> tuple[Shape, bool]:
    """Keep an upload durably and queue its job.

    Returns
    -------
    shape : Shape
    new : bool
        False where the same content is known already.

    Raises
    ------
    MeshError
        For what the cheap part of reading finds.
    StorageFull
        Nothing was kept.
    """
    digest = submission.content_hash()
    known = library.catalogue.find_content(digest)
    if known is not None and known.status != Status.FAILED:
        return known, False
    library.check_space(sum(file.size for file in submission.files))
    inspect_upload(submission.upload(), library.limits)
    upload_id = uuid.uuid4().hex
    try:
        shape, new = library.catalogue.accept(
            id=uuid.uuid4().hex,
            name=submission.display_name(),
            metadata=submission.metadata,
            sha256=digest,
            files=_store(library, upload_id, submission),
            allow_untextured=submission.allow_untextured,
        )
    except BaseException:
        library.files.delete_all(f"uploads/{upload_id}")
        raise
    if not new:  # somebody sent the same at the same time
        library.files.delete_all(f"uploads/{upload_id}")
    elif known is not None:  # it had failed, and now has new files
        _delete_files(library, known.files)
    return shape, new


def find_similar(library: Library, shape_id: str, question: Question) -> Answer:
    """Rank the other shapes by their distance to a stored one.

    Raises
    ------
    ShapeNotFound, NotReady, UnknownMethod, BadWeights
    """
    start = time.perf_counter()
    names = {LANDMARKS, *(block.name for block in method(question.method).blocks)}

    def query() -> tuple[str, Mapping[str, SingleArray]]:
        stored = library.catalogue.query_blocks(shape_id, names)
        return known_vocabulary(stored.vocabulary_id), stored.blocks

    def landmarks(blocks: Mapping[str, SingleArray]) -> QueryLandmarks:
        return _stored_landmarks(library, shape_id, blocks)

    found = _rank(library, question, query, landmarks, exclude=(shape_id,))
    return _answer(library, question, found, start)


def search_upload(
    library: Library,
    executor: Executor,
    submission: Submission,
    question: Question,
    describe: Describe = describe_files,
) -> Answer:
    """Rank the shapes by their distance to a mesh that is not kept.

    Parameters
    ----------
    executor : Executor
        Where ``describe`` runs.

    Raises
    ------
    MeshError, UnknownMethod, BadWeights
    """
    start = time.perf_counter()
    check_question(question)
    inspect_upload(submission.upload(), library.limits)
    described = executor.submit(
        describe, submission.paths, submission.allow_untextured, library.parameters, library.limits
    ).result()
    found = search_description(library, described, question)
    return _answer(library, question, found, start, described.facts)


def search_description(
    library: Library, description: Description, question: Question
) -> list[tuple[str, float]]:
    """Return ids and distances of the shapes nearest to a description."""

    def query() -> tuple[str, Mapping[str, SingleArray]]:
        vocabulary = active_vocabulary(library)
        require_same(description.fingerprint, vocabulary)
        return vocabulary.id, {**description.blocks, **quantise(description.signatures, vocabulary)}

    def landmarks(blocks: Mapping[str, SingleArray]) -> QueryLandmarks:
        return QueryLandmarks(packed=blocks[LANDMARKS], ladder=description.signatures[QUERY_LADDER])

    return _rank(library, question, query, landmarks)


def change_shape(
    library: Library, shape_id: str, *, name: str | None = None, metadata: Mapping[str, Any] | None = None
) -> Shape:
    """Rename a shape, or replace its metadata, or both."""
    return library.catalogue.update(shape_id, name=name, metadata=metadata)


def remove_shape(library: Library, shape_id: str) -> None:
    """Forget a shape, then delete its files; `service.jobs.sweeping` ends what a crash leaves half done."""
    files = library.reserve.despite_full_disk(lambda: library.catalogue.remove(shape_id))
    _delete_files(library, files)
    library.files.delete_all(f"shapes/{shape_id}")
    library.reserve.fill()


def check_question(question: Question) -> None:
    """Refuse an unknown method or bad weights before anything is computed."""
    chosen = method(question.method)
    if question.weights is not None:
        with_weights(chosen, question.weights)


def _store(library: Library, upload_id: str, submission: Submission) -> list[StoredFile]:
    """Make the files durable, under keys of our own."""
    stored = []
    for number, file in enumerate(submission.files):
        key = upload_key(upload_id, number)
        with file.path.open("rb") as stream:
            size, sha256 = library.files.put_stream(key, stream)
        stored.append(StoredFile(name=file.name, key=key, size=size, sha256=sha256))
    return stored


def _delete_files(library: Library, files: Iterable[StoredFile]) -> None:
    for file in files:
        library.files.delete(file.key)


def _rank(
    library: Library,
    question: Question,
    query: AsQuery,
    landmarks: Callable[[Mapping[str, SingleArray]], QueryLandmarks],
    exclude: tuple[str, ...] = (),
) -> list[tuple[str, float]]:
    """Search, and refine the first where the method does; own weights ask for the blocks alone."""
    first = 0 if question.weights else method(question.method).refined
    found, blocks = _search(library, question, query, max(question.limit, first), exclude)
    if not found or not first:
        return found
    stored = library.catalogue.one_block([shape_id for shape_id, _ in found[:first]], LANDMARKS)
    return refine(found, landmarks(blocks), stored, first)[: question.limit]


def _stored_landmarks(library: Library, shape_id: str, blocks: Mapping[str, SingleArray]) -> QueryLandmarks:
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
) -> tuple[list[tuple[str, float]], Mapping[str, SingleArray]]:
    """Search with the active vocabulary, once more where another becomes active in this moment.

    Returns
    -------
    list of (id, distance)
    mapping of str to array
        The query's blocks.
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
        return found, blocks
    raise VocabularyChanged("vocabularies kept changing during the query; try again")


def _answer(
    library: Library,
    question: Question,
    found: list[tuple[str, float]],
    start: float,
    query: MeshFacts | None = None,
) -> Answer:
    """Join distances and shapes; one that was removed in this moment drops out."""
    shapes = library.catalogue.get_many([shape_id for shape_id, _ in found])
    kept = [(shapes[shape_id], distance) for shape_id, distance in found if shape_id in shapes]
    return Answer(
        method=question.method,
        milliseconds=1000 * (time.perf_counter() - start),
        hits=tuple(
            Hit(rank=rank, distance=distance, shape=shape)
            for rank, (shape, distance) in enumerate(kept, start=1)
        ),
        query=query,
    )
