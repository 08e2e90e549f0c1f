"""What the catalogue tells about a shape: frozen values, free of the database."""

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from enum import StrEnum
from typing import Any


class Status(StrEnum):
    """How far a shape has come."""

    QUEUED = "queued"  # waits for a worker
    PROCESSING = "processing"  # a worker has it
    READY = "ready"  # described, and found by searches
    FAILED = "failed"  # refused by the worker, or given up


@dataclass(frozen=True, kw_only=True)
class StoredFile:
    """One uploaded file, durable in the file store."""

    name: str  # relative path as uploaded; never used as a path here
    key: str  # where the FileStore keeps it
    size: int  # bytes
    sha256: str  # of the content, hexadecimal


@dataclass(frozen=True, kw_only=True)
class Shape:
    """One shape as the catalogue holds it."""

    id: str  # made by the caller; never used again after removal
    name: str  # for people
    status: Status  # how far it has come
    created_at: datetime  # UTC, when it was accepted first
    updated_at: datetime  # UTC, the last change
    metadata: Mapping[str, Any]  # JSON, the user's own
    sha256: str  # of the whole upload's content; unique in the catalogue
    revision: int  # the catalogue's revision at this shape's last change
    allow_untextured: bool  # accept it where a named MTL or image was not sent
    files: tuple[StoredFile, ...]  # in the order of the upload
    facts: Mapping[str, Any] | None  # what the worker found out about the mesh; None until ready
    error_code: str | None  # why it failed, stable
    error_detail: str | None  # why it failed, in words
    fingerprint: str | None = None  # of the parameters that described it; None until ready
    made_in: str | None = None  # folder of the files that were made of it; None: none of its own


@dataclass(frozen=True, kw_only=True)
class Page:
    """One page of a list."""

    items: tuple[Shape, ...]  # newest first
    next_cursor: str | None  # give it back for the next page; None at the end


@dataclass(frozen=True, kw_only=True)
class Changes:
    """What happened since a revision."""

    revision: int  # ask for the changes since this one next time
    changed: tuple[str, ...]  # ids of shapes that were added or changed, oldest change first
    removed: tuple[str, ...]  # ids of shapes that are gone; wins where an id is in both


@dataclass(frozen=True, kw_only=True)
class CatalogueState:
    """What an index compares to know whether it is up to date."""

    library: str  # random, made with the catalogue: two libraries are never confused
    revision: int  # goes up with every change
    epoch: int  # goes up when every index must be built anew
    vocabulary_id: str | None  # the active vocabulary; None until the first one
    next_vocabulary_id: str | None = None  # active once all shapes are described anew; None: nothing changes
