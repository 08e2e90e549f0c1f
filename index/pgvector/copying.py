"""Copying: rows in the binary form that PostgreSQL's COPY reads, made many at a time."""

import struct
from collections.abc import Iterator, Sequence

import numpy as np

from index.arrays import RowArray
from index.pgvector.form import KeptArray
from index.postgresql import sendable

HEAD = b"PGCOPY\n\xff\r\n\0" + bytes(8)  # no flags, nothing more in the header
END = struct.pack(">h", -1)
_LENGTH, _COUNT = struct.Struct(">i"), struct.Struct(">h")


def copied(ids: Sequence[str], kept: KeptArray, rows: RowArray) -> Iterator[bytes]:
    """Yield COPY's input for tables of (id text, vector, exact bytea).

    Parameters
    ----------
    ids : m of them
    kept : (m, width) array
        See `Form.kept`.
    rows : (m, width) array
        As the layout keeps them.
    """
    yield HEAD
    opening = struct.pack(">hh", kept.shape[1], 0)  # the numbers in a vector, and a word that is never used
    numbers = kept.astype(kept.dtype.newbyteorder(">"))
    for shape_id, vector, row in zip(ids, numbers, np.ascontiguousarray(rows), strict=True):
        name = sendable(shape_id).encode()
        fields = (name, opening + vector.tobytes(), row.tobytes())
        yield _COUNT.pack(len(fields)) + b"".join(_LENGTH.pack(len(field)) + field for field in fields)
    yield END


def literal(vector: KeptArray) -> str:
    """Return a vector (n,) as it is written in a statement; exact."""
    return f"[{','.join(map(repr, vector.astype(np.float64).tolist()))}]"
