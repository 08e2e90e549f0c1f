"""A piece of the disk held back, so that a full one can still be emptied."""

import contextlib
import logging
import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import IO, TypeVar

from index.errors import StorageFull

log = logging.getLogger(__name__)

LEAST = 2**16  # bytes that are worth holding
PIECE = 2**20  # bytes written at once, where the system cannot set space aside

Value = TypeVar("Value")


class Reserve:
    """A file of no content: what is written when the disk is full takes its place.

    Removing a shape needs room, too: a database writes what it will forget before it forgets it.

    Parameters
    ----------
    path : Path
        Where the file is; on the same disk as what it is for.
    size : int
        Bytes.
    """

    def __init__(self, path: Path, size: int) -> None:
        self._path, self._size = path, size

    def fill(self) -> bool:
        """Set space aside, as much as there is; return False where that is not all.

        On a full disk the little that a removal freed makes the next one possible.
        """
        if self._held() == self._size:
            return True
        size = self._size
        while not self._take(size):
            size //= 2
            if size < LEAST:
                return False
        return size == self._size

    def release(self) -> None:
        """Give the space back to the disk."""
        with contextlib.suppress(OSError):
            self._path.unlink(missing_ok=True)

    def despite_full_disk(self, act: Callable[[], Value]) -> Value:
        """Do something that must be possible on a full disk, once more in the reserve's place.

        Raises
        ------
        StorageFull
            Even that was not enough.
        """
        try:
            return act()
        except StorageFull:
            with self._lent():
                return act()

    @contextlib.contextmanager
    def _lent(self) -> Iterator[None]:
        self.release()
        try:
            yield
        finally:
            if not self.fill():
                log.warning(
                    "the disk is full; %d of %d bytes are held back for removals", self._held(), self._size
                )

    def _take(self, size: int) -> bool:
        """Hold so much of the disk; nothing where it has less."""
        if self._held() >= size:
            return True
        try:
            with self._path.open("wb") as file:
                _fill(file, size)
        except OSError:
            self.release()
            return False
        return True

    def _held(self) -> int:
        try:
            return self._path.stat().st_size
        except FileNotFoundError:
            return 0


def _fill(file: IO[bytes], size: int) -> None:
    """Fill an empty file, with what no file system can store in less."""
    if hasattr(os, "posix_fallocate"):
        os.posix_fallocate(file.fileno(), 0, size)
        return
    while size > 0:
        size -= file.write(os.urandom(min(PIECE, size)))
    file.flush()
    os.fsync(file.fileno())
