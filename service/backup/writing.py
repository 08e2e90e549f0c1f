"""Writing an archive: aside, with a checksum of each member, and in its place only when it is complete."""

import hashlib
import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryFile
from typing import IO, BinaryIO
from uuid import uuid4

from index.full_disk import full_disk_named
from index.local_files import flush_folder
from service.backup.layout import SUMS
from service.backup.tar import BLOCK, END, Member, header_of, padding_of

Mark = tuple[int, int]  # places in the archive and in its list of checksums


@dataclass(frozen=True, kw_only=True)
class Written:
    """What a member turned out to be."""

    size: int  # bytes
    sha256: str  # hexadecimal


class ArchiveWriter:
    """Adds members to an archive whose place can be sought.

    Parameters
    ----------
    file : binary file
        The archive.
    sums : binary file
        Where the checksums wait for the end; a large library has too many for the memory.
    moment : int
        Seconds since 1970, the time of every member.
    """

    def __init__(self, file: BinaryIO, sums: IO[bytes], moment: int) -> None:
        self._file, self._sums, self._moment = file, sums, moment

    def add(self, name: str, pieces: Iterable[bytes]) -> Written:
        """Add a member; where its pieces end with an error, nothing of it is left."""
        before = self.mark()
        try:
            written = self._write(name, pieces)
        except Exception:
            self.rewind(before)
            raise
        self._sums.write(f"{written.sha256}  {name}\n".encode())
        return written

    def mark(self) -> Mark:
        """Return where the archive ends now."""
        return self._file.tell(), self._sums.tell()

    def rewind(self, mark: Mark) -> None:
        """Forget what was added since."""
        for file, place in zip((self._file, self._sums), mark, strict=True):
            file.seek(place)
            file.truncate()

    def finish(self) -> int:
        """Add the checksums and the end; return the size of the whole."""
        self._sums.seek(0)
        self._write(SUMS, iter(lambda: self._sums.read(1 << 20), b""))
        self._file.write(END)
        return self._file.tell()

    def _write(self, name: str, pieces: Iterable[bytes]) -> Written:
        start, size, digest = self._file.tell(), 0, hashlib.sha256()
        self._file.write(bytes(BLOCK))  # the header comes when the size is known
        for piece in pieces:
            digest.update(piece)
            size += self._file.write(piece)
        self._file.write(padding_of(size))
        end = self._file.tell()
        self._file.seek(start)
        self._file.write(header_of(Member(name=name, size=size), self._moment))
        self._file.seek(end)
        return Written(size=size, sha256=digest.hexdigest())


@contextmanager
def writing_archive(path: Path, replace: bool, moment: int) -> Iterator[ArchiveWriter]:
    """Make the archive that the block writes, or nothing.

    Raises
    ------
    FileExistsError
        There is something at ``path`` and it may not be replaced.
    StorageFull
        The disk is full; nothing is left behind.
    """
    with full_disk_named(), _aside(path, replace) as file, TemporaryFile(dir=path.parent) as sums:
        writer = ArchiveWriter(file, sums, moment)
        yield writer
        writer.finish()


@contextmanager
def _aside(path: Path, replace: bool) -> Iterator[BinaryIO]:
    _refuse_existing(path, replace)
    aside = path.with_name(f".faience-export-{uuid4().hex}")
    try:
        with aside.open("xb") as file:
            yield file
            file.flush()
            os.fsync(file.fileno())
        _refuse_existing(path, replace)  # somebody may have made it meanwhile
        aside.replace(path)
    except BaseException:
        aside.unlink(missing_ok=True)
        raise
    flush_folder(path.parent)


def _refuse_existing(path: Path, replace: bool) -> None:
    if path.is_dir() or (path.exists() and not replace):
        raise FileExistsError(f"{path} exists already")
