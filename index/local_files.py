"""LocalFiles: files in a folder, which survive a crash once `put` has returned."""

import contextlib
import hashlib
import os
import shutil
import sys
import time
from collections.abc import Callable, Iterable, Iterator
from itertools import groupby
from pathlib import Path
from typing import IO, BinaryIO
from uuid import uuid4

from index.errors import FileMissing
from index.files import CHUNK, KEY, FileFacts, Stream, check_key
from index.full_disk import full_disk_named

_INCOMING = ".incoming"  # half-written files; no key can start with a dot
_ATTEMPTS = 20  # to rename into a folder that others empty and remove


class LocalFiles:
    """A local folder of files under keys of our own making.

    A file is written aside, flushed to the disk, then renamed: readers see all of it or nothing.

    Parameters
    ----------
    root : Path
        The folder; made on first use.
    """

    def __init__(self, root: Path) -> None:
        self._root = root

    @property
    def folder(self) -> Path:
        """Where the files are, each under its key."""
        return self._root

    def check(self) -> None:
        """Do nothing: the folder is made on first use."""

    def put(self, key: str, data: bytes, *, flushed: bool = True) -> None:
        """Keep `data` under `key`, replacing what was there; durably, if flushed. StorageFull as `write`."""
        self.write(key, lambda file: file.write(data), flushed=flushed)

    def put_stream(self, key: str, stream: Stream, *, flushed: bool = True) -> tuple[int, str]:
        """Keep what `stream` holds, piece by piece; return its size and SHA-256. StorageFull as `write`."""
        digest = hashlib.sha256()

        def copy(file: IO[bytes]) -> int:
            while piece := stream.read(CHUNK):
                digest.update(piece)
                file.write(piece)
            return file.tell()

        return self.write(key, copy, flushed=flushed), digest.hexdigest()

    def write(self, key: str, fill: Callable[[IO[bytes]], int], *, flushed: bool = True) -> int:
        """Keep what `fill` writes into the file it is given; return what it returns.

        Parameters
        ----------
        flushed : bool
            False where many files follow each other and the caller calls `flush` after the last.

        Raises
        ------
        StorageFull
            The disk is full; nothing is left behind.
        """
        final = self.path(key)
        aside = self._root / _INCOMING / uuid4().hex
        with full_disk_named():
            try:
                _make_folder(aside.parent, flushed)
                size = _write_through(aside, fill, flushed)
                self._rename(aside, final, flushed)
            except BaseException:
                aside.unlink(missing_ok=True)
                self._prune(final.parent)
                raise
        return size

    def flush(self, keys: Iterable[str]) -> None:
        """Make files durable that were put unflushed."""
        if sys.platform == "linux":  # which waits here, and promises what flushing each file would; sync(2)
            os.sync()
        else:
            self._flush_each(keys)

    def get(self, key: str) -> bytes:
        """Return the whole content; FileMissing where there is none."""
        with self.open(key) as file:
            return file.read()

    def get_part(self, key: str, start: int, stop: int) -> bytes:
        """Return the bytes from `start` up to `stop`; FileMissing where there is none."""
        with self.open(key) as file:
            file.seek(start)
            return file.read(stop - start)

    def pieces(self, key: str) -> Iterator[bytes]:
        """Yield the content; FileMissing where there is none, OSError where it cannot be read."""
        with self.open(key) as file:
            while piece := file.read(CHUNK):
                yield piece

    def open(self, key: str) -> BinaryIO:
        """Open the file for reading; FileMissing where there is none."""
        with _absent_named(key):
            return self.path(key).open("rb")

    def facts(self, key: str) -> FileFacts:
        """Return what is known of a file; FileMissing where there is none."""
        with _absent_named(key):
            found = self.path(key).stat()
        return FileFacts(size=found.st_size, changed=found.st_mtime, tag=f"{found.st_mtime}-{found.st_size}")

    def path(self, key: str) -> Path:
        """Return where the file is, or would be; ValueError for a key that we cannot have made."""
        return self._root / check_key(key)

    def address(self, key: str, seconds: float) -> None:
        """Return None: what lies on a disk has no address."""

    def changed(self, key: str) -> float:
        """Return when a file was written, in seconds since 1970; this moment where it is gone."""
        try:
            return self.path(key).stat().st_mtime
        except FileNotFoundError:  # removed beside us
            return time.time()

    def changes(self, prefix: str) -> Iterator[tuple[str, float]]:
        """Yield the keys under a folder, in order, each with when it was written."""
        for key in self.keys(prefix):
            yield key, self.changed(key)

    def touch(self, key: str) -> bool:
        """Make a file as young as if it were written now; False where it is gone."""
        try:
            os.utime(self.path(key))
        except FileNotFoundError:
            return False
        return True

    def delete(self, key: str) -> None:
        """Remove one file and the folders that this empties; absent is fine."""
        path = self.path(key)
        path.unlink(missing_ok=True)
        self._prune(path.parent)

    def delete_all(self, prefix: str) -> None:
        """Remove every file under the folder `prefix`; absent is fine."""
        path = self.path(prefix)
        shutil.rmtree(path, ignore_errors=True)
        self._prune(path.parent)

    def keys(self, prefix: str = "") -> Iterator[str]:
        """Yield the keys under the folder `prefix` (all without one), in order.

        What we cannot have made, such as ``.DS_Store``, is not ours to tell of.
        """
        start = self.path(prefix) if prefix else self._root
        for path in sorted(start.rglob("*")):
            key = path.relative_to(self._root).as_posix()
            if KEY.fullmatch(key) and path.is_file():
                yield key

    def sweep(self, older_than_seconds: float) -> int:
        """Remove half-written files that a killed process left; return how many."""
        limit = time.time() - older_than_seconds
        swept = 0
        for path in (self._root / _INCOMING).glob("*"):
            with contextlib.suppress(FileNotFoundError):  # its writer may finish right now
                if path.stat().st_mtime <= limit:
                    path.unlink()
                    swept += 1
        return swept

    def _flush_each(self, keys: Iterable[str]) -> None:
        above = {self._root.parent}
        for folder, paths in groupby(map(self.path, keys), key=lambda path: path.parent):
            for path in paths:
                _flush_file(path)
            flush_folder(folder)
            above.update(self._root / parent for parent in folder.relative_to(self._root).parents)
        for folder in above:
            flush_folder(folder)

    def _rename(self, aside: Path, final: Path, flushed: bool) -> None:
        for left in reversed(range(_ATTEMPTS)):
            try:
                _make_folder(final.parent, flushed)
                aside.replace(final)
                break
            except (FileNotFoundError, FileExistsError):  # a delete beside us pruned the folder just now
                if not left:
                    raise
        if flushed:
            flush_folder(final.parent)

    def _prune(self, folder: Path) -> None:
        while folder != self._root:
            try:
                folder.rmdir()
            except FileNotFoundError:
                pass
            except OSError:  # not empty
                return
            folder = folder.parent


@contextlib.contextmanager
def _absent_named(key: str) -> Iterator[None]:
    try:
        yield
    except FileNotFoundError:
        raise FileMissing(f"no file is kept under {key!r}") from None


def _write_through(path: Path, fill: Callable[[IO[bytes]], int], flushed: bool) -> int:
    with path.open("xb") as file:
        size = fill(file)
        file.flush()
        if flushed:
            os.fsync(file.fileno())
    return size


def _make_folder(folder: Path, flushed: bool) -> None:
    """Make a folder whose own entry is durable too, and that of each parent it needed."""
    if folder.is_dir():
        return
    _make_folder(folder.parent, flushed)
    folder.mkdir(exist_ok=True)
    if flushed:
        flush_folder(folder.parent)


def _flush_file(path: Path) -> None:
    """Make the content of a file durable."""
    with path.open("rb") as file:
        os.fsync(file.fileno())


def flush_folder(folder: Path) -> None:
    """Make the names in a folder durable."""
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
