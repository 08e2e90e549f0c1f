"""Index files: a method's rows and their sketch on disk, only ever a cache of the catalogue.

A file is 32 bytes of SHA-256 over the rest, then one line of JSON, then arrays one after another.
"""

import hashlib
import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from io import BufferedReader
from pathlib import Path
from typing import IO, Any

import numpy as np
import numpy.typing as npt

from index.errors import DamagedIndex
from index.local_files import LocalFiles

_FORMAT = 2  # raised whenever this file's layout changes
_PIECE = 1 << 24  # bytes written at once
_DIGEST = hashlib.sha256().digest_size

Arrays = Mapping[str, npt.NDArray[Any]]


@dataclass(frozen=True, kw_only=True)
class Header:
    """What a file says of itself."""

    library: str  # of the catalogue that it is a view of
    epoch: int  # of that catalogue
    vocabulary_id: str | None  # whose words the rows are in; its name follows from its parameters too
    blocks: list[str]  # names, in the order of the layout
    lengths: list[int]  # numbers in each block
    ids: list[str]  # of the rows, in their order
    revisions: list[int]  # of each shape, as held here; 0 where it has changed since
    format: int = _FORMAT


def save_index(store: LocalFiles, key: str, header: Header, arrays: Arrays) -> None:
    """Write a file aside, flush it, and put it in the place of the last one."""

    def fill(file: IO[bytes]) -> int:
        digest = hashlib.sha256()
        file.write(bytes(_DIGEST))
        for piece in _pieces(header, arrays):
            digest.update(piece)
            file.write(piece)
        size = file.tell()
        file.seek(0)
        file.write(digest.digest())
        return size

    store.write(key, fill)


def load_index(path: Path) -> tuple[Header, dict[str, npt.NDArray[Any]]]:
    """Check every byte of a file; return what it says of itself, and its arrays.

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
        header, shapes = _header_of(file.readline(), path.name)
        return header, {name: _read(file, *described) for name, described in shapes.items()}


def _pieces(header: Header, arrays: Arrays) -> Iterator[bytes | memoryview]:
    shapes = {name: (array.dtype.str, array.shape) for name, array in arrays.items()}
    yield json.dumps({"header": asdict(header), "arrays": shapes}).encode() + b"\n"
    for array in arrays.values():
        data = memoryview(np.ascontiguousarray(array).reshape(-1).view(np.uint8).data)
        for start in range(0, len(data), _PIECE):
            yield data[start : start + _PIECE]


def _header_of(line: bytes, name: str) -> tuple[Header, dict[str, tuple[str, Sequence[int]]]]:
    told = json.loads(line)  # the checksum was right: what is here was written by us
    form = told.get("format", told.get("header", {}).get("format"))
    if form != _FORMAT:
        raise DamagedIndex(f"{name} has format {form}, not {_FORMAT}")
    return Header(**told["header"]), told["arrays"]


def _read(file: BufferedReader, dtype: str, shape: Sequence[int]) -> npt.NDArray[Any]:
    array = np.empty(shape, dtype)  # memory of its own, which may grow
    file.readinto(array.reshape(-1).view(np.uint8).data)
    return array
