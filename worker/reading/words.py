"""Text cut into words without a Python loop: where each starts, where it ends, on which line."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from worker.arrays import BoolArray, ByteArray, IntArray

BLOCK = 1 << 20  # bytes of text that are cut at a time, so that long files need little memory

_BLANK = np.zeros(256, dtype=np.bool_)
_BLANK[list(b" \t\n\v\f\r")] = True


@dataclass(frozen=True, kw_only=True, eq=False)
class Words:
    """The words of a piece of text, in order."""

    text: ByteArray  # (n,), the bytes
    starts: IntArray  # (k,), position of each word's first byte
    ends: IntArray  # (k,), position after its last byte
    lines: IntArray  # (k,), number of its line, from first_line

    def __getitem__(self, chosen: BoolArray | IntArray) -> "Words":
        """Return the chosen words of the same text."""
        return Words(
            text=self.text, starts=self.starts[chosen], ends=self.ends[chosen], lines=self.lines[chosen]
        )

    def word(self, position: int) -> str:
        """Return one word, for a message or a slow path."""
        found = self.text[self.starts[position] : self.ends[position]].tobytes()
        return found.decode("utf-8", "replace")


def split_words(text: bytes, first_line: int = 1) -> Words:
    """Cut text at blanks and line ends.

    Parameters
    ----------
    text : bytes
        Lines that end with a line feed.
    first_line : int
        The number of the first line.
    """
    array = np.frombuffer(text, dtype=np.uint8)
    blank = np.ones(array.size + 2, dtype=np.bool_)
    blank[1:-1] = _BLANK[array]
    starts = np.flatnonzero(blank[:-1] & ~blank[1:])
    ends = np.flatnonzero(~blank[:-1] & blank[1:])
    line_ends = np.flatnonzero(array == ord("\n"))
    lines = np.searchsorted(line_ends, starts) + first_line
    return Words(text=array, starts=starts, ends=ends, lines=lines)


def blocks(text: bytes, size: int = BLOCK) -> Iterator[tuple[bytes, int]]:
    """Yield pieces of about `size` bytes that end at line ends, each with the number of its first line."""
    start, line = 0, 1
    while start < len(text):
        end = text.find(b"\n", start + size) + 1 or len(text)
        piece = text[start:end]
        yield piece, line
        start, line = end, line + piece.count(b"\n")


def with_line_feeds(text: bytes) -> bytes:
    """Return the text with every line end, of Windows or old Macintosh too, written as a line feed."""
    return text.replace(b"\r\n", b"\n").replace(b"\r", b"\n") if b"\r" in text else text
