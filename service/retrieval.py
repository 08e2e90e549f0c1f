"""Use cases, free of HTTP: take a mesh in, change it, remove it, and find what is similar."""

import logging
import time
import uuid
from collections.abc import Iterable, Iterator, Mapping
from concurrent.futures import Executor
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from typing import Any

from index.errors import StorageUnreachable
from index.renewals import RenewalProgress
from index.shapes import Shape, Status, StoredFile
from index.watch import stage
from service.asking import Found, Question, check_question, rank_description, rank_near, rank_query
from service.intake.submissions import Submission
from service.jobs.describing import Describe, describe_files
from service.library import Library
from service.relations.relating import relate, relate_stored
from service.relations.relation import Related
from service.relations.sides import described_side, remembered_side
from service.remembered_words import in_active_words
from service.remembering import recall, remember
from service.storage import upload_key
from worker.describe import MeshFacts
from worker.reading.upload import inspect_upload

log = logging.getLogger(__name__)

DESCRIBE, RELATIONS = "describe", "relations"  # stages of a query before and after those of `service.asking`


@dataclass(frozen=True, kw_only=True)
class Hit:
    """One result."""

    rank: int  # from 1
    distance: float  # of the method
    shape: Shape
    relation: Related | None = None  # to the query; None beyond those that the method registers


@dataclass(frozen=True, kw_only=True)
class Asked:
    """A mesh that is no shape of the library."""

    name: str  # for people
    facts: MeshFacts
    id: str | None = None  # under which it is remembered for a while; None where it is not


@dataclass(frozen=True, kw_only=True)
class Answer:
    """A ranked answer."""

    method: str
    milliseconds: float  # from the question to here
    hits: tuple[Hit, ...]  # nearest first
    query: Asked | None = None  # a mesh that is no shape of the library
    partly: RenewalProgress | None = None  # while all are described anew: with how many it was compared
    exact: bool = True  # whether no shape can be missing


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
        with _left_to_sweeper():
            library.files.delete_all(f"uploads/{upload_id}")
        raise
    with _left_to_sweeper():
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
    found = rank_near(library, shape_id, question)
    asked = found.registered if question.relations else ()
    with stage(RELATIONS, question.method):
        related = relate_stored(library, shape_id, asked, found.vocabulary_id)
    return _answer(library, question, found, related, start)


def search_upload(
    library: Library,
    executor: Executor,
    submission: Submission,
    question: Question,
    describe: Describe = describe_files,
    *,
    remembered: bool = False,
) -> Answer:
    """Rank the shapes by their distance to a mesh that is not kept.

    Parameters
    ----------
    executor : Executor
        Where ``describe`` runs.
    remembered : bool
        Whether it can be asked about again for a while; see `service.remembering`.

    Raises
    ------
    MeshError, UnknownMethod, BadWeights
    """
    start = time.perf_counter()
    check_question(question)
    inspect_upload(submission.upload(), library.limits)
    with stage(DESCRIBE, question.method):
        described = executor.submit(
            describe, submission.contents, submission.allow_untextured, library.parameters, library.limits
        ).result()
    found = rank_description(library, described, question)
    query = described_side(described, found.blocks, ((file.name, file.sha256) for file in submission.files))
    asked = found.registered if question.relations else ()
    with stage(RELATIONS, question.method):
        related = relate(library, query, asked, found.vocabulary_id)
    query_id = (
        remember(library, submission, described, found.blocks, found.vocabulary_id) if remembered else None
    )
    asked_about = Asked(id=query_id, name=submission.display_name(), facts=described.facts)
    return _answer(library, question, found, related, start, asked_about)


def find_remembered(library: Library, query_id: str, question: Question) -> Answer:
    """Rank the shapes by their distance to a mesh that was searched for before.

    Raises
    ------
    QueryNotFound, UnknownMethod, BadWeights
    """
    start = time.perf_counter()
    check_question(question)
    query = recall(library, query_id)
    found = rank_query(library, partial(in_active_words, library, query), query.ladder, question)
    related: Mapping[str, Related] = {}
    if question.relations:
        with stage(RELATIONS, question.method):
            side = remembered_side(library, query, found.blocks)
            related = relate(library, side, found.registered, found.vocabulary_id)
    asked = Asked(id=query.id, name=query.name, facts=query.facts)
    return _answer(library, question, found, related, start, asked)


def change_shape(
    library: Library, shape_id: str, *, name: str | None = None, metadata: Mapping[str, Any] | None = None
) -> Shape:
    """Rename a shape, or replace its metadata, or both."""
    return library.catalogue.update(shape_id, name=name, metadata=metadata)


def remove_shape(library: Library, shape_id: str) -> None:
    """Forget a shape, then delete its files; `service.jobs.sweeping` ends what a crash leaves half done."""
    files = library.reserve.despite_full_disk(lambda: library.catalogue.remove(shape_id))
    with _left_to_sweeper():
        _delete_files(library, files)
        library.files.delete_all(f"shapes/{shape_id}")
    library.reserve.fill()


def _store(library: Library, upload_id: str, submission: Submission) -> list[StoredFile]:
    """Make the files durable, under keys of our own."""
    stored = []
    for number, file in enumerate(submission.files):
        key = upload_key(upload_id, number)
        with file.path.open("rb") as stream:
            size, sha256 = library.files.put_stream(key, stream)
        stored.append(StoredFile(name=file.name, key=key, size=size, sha256=sha256))
    return stored


@contextmanager
def _left_to_sweeper() -> Iterator[None]:
    """Go on where files that nobody needs cannot be deleted now: what was promised does not depend on it."""
    try:
        yield
    except StorageUnreachable as error:
        log.warning("files are left to the sweeper: %s", error)


def _delete_files(library: Library, files: Iterable[StoredFile]) -> None:
    for file in files:
        library.files.delete(file.key)


def _answer(
    library: Library,
    question: Question,
    found: Found,
    related: Mapping[str, Related],
    start: float,
    query: Asked | None = None,
) -> Answer:
    """Join distances, relations and shapes; one that was removed in this moment drops out."""
    shapes = library.catalogue.get_many([shape_id for shape_id, _ in found.ranked])
    kept = [(shapes[shape_id], distance) for shape_id, distance in found.ranked if shape_id in shapes]
    return Answer(
        method=question.method,
        milliseconds=1000 * (time.perf_counter() - start),
        hits=tuple(
            Hit(rank=rank, distance=distance, shape=shape, relation=related.get(shape.id))
            for rank, (shape, distance) in enumerate(kept, start=1)
        ),
        query=query,
        partly=library.catalogue.renewal() if found.partly else None,
        exact=found.exact,
    )
