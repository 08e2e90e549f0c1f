"""FileStore: what every place for files promises, a folder or a bucket."""

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO, Protocol

KEY = re.compile(r"[A-Za-z0-9_-][A-Za-z0-9._-]*(/[A-Za-z0-9_-][A-Za-z0-9._-]*)*")
CHUNK = 1 << 20  # bytes read at once


class Stream(Protocol):
    """Where the bytes of a file come from."""

    def read(self, size: int, /) -> bytes:
        """Return at most so many bytes; none at the end."""


@dataclass(frozen=True, kw_only=True)
class FileFacts:
    """What is known of a file without reading it."""

    size: int  # bytes
    changed: float  # when it was written, in seconds since 1970
    tag: str  # another one when the content is another


class FileStore(Protocol):
    """Files under keys of our own making, that survive a crash once they are put.

    A reader sees all of a file or nothing. A store can be pickled, small, and opened again by another
    process. Every method raises ValueError for a key that we cannot have made, and StorageUnreachable
    where the files are on another machine, which does not answer.
    """

    @property
    def folder(self) -> Path | None:
        """Where the files are on this machine, each under its key; None where they are elsewhere."""

    def check(self) -> None:
        """Return where the files can be reached; StorageUnreachable where they cannot."""

    def put(self, key: str, data: bytes, *, flushed: bool = True) -> None:
        """Keep `data` under `key`, durably, replacing what was there.

        Parameters
        ----------
        flushed : bool
            False where many files follow each other and the caller calls `flush` after the last.

        Raises
        ------
        StorageFull
            The disk is full; nothing is left behind.
        """

    def put_stream(self, key: str, stream: Stream, *, flushed: bool = True) -> tuple[int, str]:
        """Keep what `stream` holds, piece by piece; return its size and SHA-256.

        Raises as `put` does; where reading fails, nothing is left behind either.
        """

    def flush(self, keys: Iterable[str]) -> None:
        """Make files durable that were put unflushed."""

    def get(self, key: str) -> bytes:
        """Return the whole content; FileMissing where there is none."""

    def get_part(self, key: str, start: int, stop: int) -> bytes:
        """Return the bytes from `start` up to `stop`, which the file has; FileMissing where there is none."""

    def pieces(self, key: str) -> Iterator[bytes]:
        """Yield the content, a few MiB at a time; FileMissing where there is none."""

    def open(self, key: str) -> BinaryIO:
        """Return the content as a file in which one can seek; FileMissing where there is none."""

    def facts(self, key: str) -> FileFacts:
        """Return what is known of a file; FileMissing where there is none."""

    def address(self, key: str, seconds: float) -> str | None:
        """Return a URL under which anybody can read the file for a while; None where there is no such."""

    def changed(self, key: str) -> float:
        """Return when a file was written, in seconds since 1970; this moment where it is gone."""

    def changes(self, prefix: str) -> Iterator[tuple[str, float]]:
        """Yield the keys under a folder, in order, each with when it was written."""

    def touch(self, key: str) -> bool:
        """Make a file as young as if it were written now; False where it has to be put again for that."""

    def delete(self, key: str) -> None:
        """Remove one file; absent is fine."""

    def delete_all(self, prefix: str) -> None:
        """Remove every file under the folder `prefix`; absent is fine."""

    def keys(self, prefix: str = "") -> Iterator[str]:
        """Yield the keys under the folder `prefix` (all without one), in order.

        What we cannot have made, such as ``.DS_Store``, is not ours to tell of.
        """

    def sweep(self, older_than_seconds: float) -> int:
        """Remove half-written files that a killed process left; return how many."""


def check_key(key: str) -> str:
    """Return a key; ValueError for one that we cannot have made."""
    if not KEY.fullmatch(key):
        raise ValueError(f"not a file key: {key!r}")
    return key
