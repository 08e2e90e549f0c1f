"""Reading an archive from its beginning, a member after the other; nothing it says is believed."""

import hashlib
import io
from collections.abc import Callable, Iterator
from typing import Any, BinaryIO

from index.errors import DamagedExport
from service.backup.tar import BLOCK, member_of, padding_of

_PIECE = 1 << 20  # bytes

Told = Callable[[int], None]  # takes the bytes read so far


class MemberStream(io.RawIOBase):
    """The content of one member, which must be read before the next one.

    Parameters
    ----------
    file : binary file
        The archive, at the beginning of the content.
    """

    def __init__(self, file: BinaryIO, name: str, size: int) -> None:
        self.name, self.size = name, size
        self._file, self._left, self._digest = file, size, hashlib.sha256()

    def readable(self) -> bool:
        """Say so to `io.BufferedReader`."""
        return True

    def readinto(self, buffer: Any) -> int:
        """Take the next piece; DamagedExport where the archive ends before its member."""
        piece = self._file.read(min(len(buffer), self._left))
        if not piece and self._left and len(buffer):
            raise DamagedExport(f"the export ends inside {self.name!r:.100}: it was cut")
        self._digest.update(piece)
        self._left -= len(piece)
        buffer[: len(piece)] = piece
        return len(piece)

    def lines(self, longest: int) -> Iterator[bytes]:
        """Yield the lines, none of them longer than so many bytes."""
        buffered = io.BufferedReader(self, _PIECE)
        while line := buffered.readline(longest + 1):
            if len(line) > longest:
                raise DamagedExport(f"{self.name!r:.100} has a line of more than {longest} bytes")
            yield line

    def pass_over(self) -> None:
        """Read what nobody took, so that the digest is complete."""
        while self.read(_PIECE):
            pass

    def digest(self) -> str:
        """Return the SHA-256 of what was read, hexadecimal."""
        return self._digest.hexdigest()


def members_of(file: BinaryIO, told: Told) -> Iterator[MemberStream]:
    """Yield every member, and check what lies between them.

    Raises
    ------
    DamagedExport
        Something is no plain file, the archive is cut, or more follows its end.
    """
    file.seek(0)
    while (member := member_of(file.read(BLOCK))) is not None:
        stream = MemberStream(file, member.name, member.size)
        yield stream
        stream.pass_over()
        padding = padding_of(member.size)
        if file.read(len(padding)) != padding:
            raise DamagedExport(f"the export is damaged or cut after {member.name!r:.100}")
        told(file.tell())
    while piece := file.read(_PIECE):
        if piece.strip(b"\0"):
            raise DamagedExport("something follows the end of the export")
