"""Index files: a method's vectors on disk, only ever a cache of the catalogue.

A file is 32 bytes of SHA-256 over the rest, then one line of JSON, then the vectors, float32.
"""

import hashlib
import json
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import IO

import numpy as np

from index.arrays import SingleArray
from index.errors import DamagedIndex
from index.files import FileStore
from index.vectors import Vectors

_FORMAT = 1  # raised whenever this file's layout changes
_CHUNK = 1024  # vectors written or read at once
_DIGEST = hashlib.sha256().digest_size

Rows = tuple[list[str], SingleArray]  # m ids and their vectors (m, width), not scaled


@dataclass(frozen=True, kw_only=True)
class Header:
    """What a file says of itself."""

    library: str  # of the catalogue that it is a view of
    epoch: int  # of that catalogue
    vocabulary_id: str | None  # whose words the vectors are in; its name follows from its parameters too
    blocks: list[str]  # names, in the order of the layout
    lengths: list[int]  # numbers in each block
    ids: list[str]  # of the vectors, in their order
    revisions: list[int]  # of each shape, as held here; 0 where it has changed since
    format: int = _FORMAT

    @property
    def width(self) -> int:
        """Numbers in one vector."""
        return sum(self.lengths)


def save_index(store: FileStore, key: str, header: Header, vectors: Vectors) -> None:
    """Write a file aside, flush it, and put it in the place of the last one."""

    def fill(file: IO[bytes]) -> int:
        digest = hashlib.sha256()
        file.write(bytes(_DIGEST))
        for piece in _pieces(header, vectors):
            digest.update(piece)
            file.write(piece)
        size = file.tell()
        file.seek(0)
        file.write(digest.digest())
        return size

    store.write(key, fill)


@contextmanager
def opened_index(path: Path) -> Iterator[tuple[Header, Iterator[Rows]]]:
    """Check every byte of a file; give what it says of itself, and its vectors piece by piece.

    Raises
    ------
    DamagedIndex
        It is absent, truncated, altered or of another format.
    """
    try:
        file = path.open("rb")
    except OSError as error:
        raise DamagedIndex(f"{path.name} cannot be read") from error
    with file:
        told = file.read(_DIGEST)
        if hashlib.file_digest(file, "sha256").digest() != told:
            raise DamagedIndex(f"the checksum of {path.name} is wrong")
        file.seek(_DIGEST)
        header = _header_of(file.readline(), path.name)
        yield header, _rows(file, header)


def _pieces(header: Header, vectors: Vectors) -> Iterator[bytes]:
    yield json.dumps(asdict(header)).encode() + b"\n"
    for start in range(0, len(vectors), _CHUNK):
        positions = np.arange(start, min(start + _CHUNK, len(vectors)))
        yield vectors.rows(positions).astype("<f4", copy=False).tobytes()


def _header_of(line: bytes, name: str) -> Header:
    told = json.loads(line)  # the checksum was right: what is here was written by us
    if told.get("format") != _FORMAT:
        raise DamagedIndex(f"{name} has format {told.get('format')}, not {_FORMAT}")
    return Header(**told)


def _rows(file: IO[bytes], header: Header) -> Iterator[Rows]:
    for start in range(0, len(header.ids), _CHUNK):
        ids = header.ids[start : start + _CHUNK]
        rows = np.frombuffer(file.read(4 * len(ids) * header.width), dtype="<f4")
        yield ids, rows.reshape(len(ids), header.width)
