"""Remembering queries: for an hour a mesh that is not kept can be asked about again."""

import io
import json
import logging
import re
import uuid
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass
from datetime import datetime, timedelta
from typing import Any
from zipfile import BadZipFile

import numpy as np

from index.errors import FileMissing, StorageFull, StorageUnreachable
from index.files import FileStore
from index.revisions import now
from service.intake.submissions import Submission
from service.library import Library
from service.refining import QUERY_LADDER
from service.storage import PREVIEW, SIGNATURES, THUMBNAIL, saved_arrays
from worker.arrays import SingleArray
from worker.describe import Description, MeshFacts

LIFETIME = timedelta(hours=1)
MOST = 200  # queries at once, about a megabyte each; the oldest go first
FOLDER = "queries"
GONE = "this query is not remembered any more; send its mesh again"
log = logging.getLogger(__name__)

_ID = re.compile(r"[0-9a-f]{32}")
_BLOCKS, _CARD = "blocks.npz", "query.json"  # the card is written last: a query with a card is whole


class QueryNotFound(Exception):
    """No query is remembered under this id, or not any more."""

    code = "query_not_found"


@dataclass(frozen=True, kw_only=True, eq=False)
class Remembered:
    """A described mesh that is kept for a while, in no list and found by no search."""

    id: str  # nobody can guess it
    name: str  # for people
    facts: MeshFacts
    files: tuple[tuple[str, str], ...]  # names and SHA-256
    fingerprint: str  # of the parameters that described it
    vocabulary_id: str  # whose words its blocks are in
    expires_at: datetime  # UTC
    blocks: Mapping[str, SingleArray]
    ladder: SingleArray  # the signature by which it is registered with others


def query_key(query_id: str, name: str) -> str:
    """Return the key of a file of a query; QueryNotFound for what cannot be an id."""
    if not _ID.fullmatch(query_id):
        raise QueryNotFound(f"no query has the id {query_id[:40]!r}")
    return f"{FOLDER}/{query_id}/{name}"


def remember(
    library: Library,
    submission: Submission,
    described: Description,
    blocks: Mapping[str, SingleArray],
    vocabulary_id: str,
) -> str | None:
    """Keep a described mesh for an hour; return its id.

    Parameters
    ----------
    submission : Submission
        What was sent; its files are not kept.
    blocks : mapping of str to array
        All blocks, those in words of the vocabulary too.

    Returns
    -------
    str or None
        None where the disk is full or refuses, or the storage is away: an answer does not depend on it.
    """
    query_id = uuid.uuid4().hex
    card = {
        "name": submission.display_name(),
        "facts": asdict(described.facts),
        "files": [(file.name, file.sha256) for file in submission.files],
        "fingerprint": described.fingerprint,
        "vocabulary_id": vocabulary_id,
        "expires_at": (now() + LIFETIME).isoformat(),
    }
    numbers = {**blocks, QUERY_LADDER: described.signatures[QUERY_LADDER]}
    try:
        library.check_space(0)  # what makes room needs some itself
        _make_room(library.files)
        for name, content in (
            (THUMBNAIL, described.thumbnail),
            (PREVIEW, described.preview),
            (SIGNATURES, saved_arrays(described.signatures)),
            (_BLOCKS, saved_arrays(numbers)),
            (_CARD, json.dumps(card).encode()),
        ):
            _put(library.files, query_key(query_id, name), content)
    except (StorageFull, StorageUnreachable, OSError):
        log.warning("a query could not be remembered", exc_info=True)
        with suppress(StorageUnreachable):  # what is left is old in an hour
            library.files.delete_all(f"{FOLDER}/{query_id}")
        return None
    return query_id


def recall(library: Library, query_id: str, moment: datetime | None = None) -> Remembered:
    """Return what is remembered of a query.

    Parameters
    ----------
    moment : datetime, optional
        Aware; now by default.

    Raises
    ------
    QueryNotFound
        Its hour is over, or it was described by another version.
    """
    try:
        card = json.loads(library.files.get(query_key(query_id, _CARD)))
        with np.load(io.BytesIO(library.files.get(query_key(query_id, _BLOCKS)))) as archive:
            numbers = {name: archive[name] for name in archive.files}
        found = _remembered(query_id, card, numbers)
    except (FileMissing, BadZipFile, KeyError, TypeError, ValueError):  # gone, or torn by a power cut
        raise QueryNotFound(GONE) from None
    if found.expires_at <= (moment or now()) or found.fingerprint != library.parameters.fingerprint():
        raise QueryNotFound(GONE)
    return found


def remembered_file(library: Library, query_id: str, name: str) -> bytes:
    """Return a file of a remembered query; QueryNotFound as for `recall`."""
    recall(library, query_id)
    try:
        return library.files.get(query_key(query_id, name))
    except FileMissing:  # removed in this moment
        raise QueryNotFound(GONE) from None


def forget_old(files: FileStore, older_than: float) -> int:
    """Remove what is older than so many seconds; return how many queries."""
    before = now().timestamp() - older_than
    old = [query_id for query_id, moment in _moments(files).items() if moment <= before]
    for query_id in old:
        files.delete_all(f"{FOLDER}/{query_id}")
    return len(old)


def _remembered(query_id: str, card: Mapping[str, Any], numbers: dict[str, SingleArray]) -> Remembered:
    facts = {**card["facts"], "warnings": tuple(card["facts"]["warnings"])}
    return Remembered(
        id=query_id,
        name=card["name"],
        facts=MeshFacts(**facts),
        files=tuple((name, sha256) for name, sha256 in card["files"]),
        fingerprint=card["fingerprint"],
        vocabulary_id=card["vocabulary_id"],
        expires_at=datetime.fromisoformat(card["expires_at"]),
        ladder=numbers.pop(QUERY_LADDER),
        blocks=numbers,
    )


def _make_room(files: FileStore) -> None:
    """Forget what is over its hour, and the oldest beyond a number."""
    forget_old(files, LIFETIME.total_seconds())
    oldest_first = sorted((moment, query_id) for query_id, moment in _moments(files).items())
    for _, query_id in oldest_first[: max(len(oldest_first) - MOST + 1, 0)]:
        files.delete_all(f"{FOLDER}/{query_id}")


def _moments(files: FileStore) -> dict[str, float]:
    """Return when the newest file of each query was written."""
    found: dict[str, float] = {}
    for key, moment in files.changes(FOLDER):
        query_id = key.split("/")[1]
        found[query_id] = max(found.get(query_id, 0.0), moment)
    return found


def _put(files: FileStore, key: str, content: bytes) -> None:
    # not flushed: nobody was promised that a query survives a power cut
    files.put(key, content, flushed=False)
