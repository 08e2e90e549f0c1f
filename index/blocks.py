"""Blocks as bytes: float32 vectors, kept exactly, packed where many of their numbers are zero."""

import struct
import zlib
from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from index.arrays import SingleArray
from index.errors import BadBlock

_HEADER = struct.Struct("<BI")  # packing, number of values
_RAW, _PACKED = 0, 1
_LEVEL = 4  # of zlib; higher ones gain nothing on such data


def encode_block(block: SingleArray) -> bytes:
    """Return a vector (n,) as bytes: a header, then little-endian float32, by zlib where that is shorter."""
    raw = block.astype("<f4", copy=False).tobytes()
    packed = zlib.compress(raw, _LEVEL)
    if len(packed) < len(raw):
        return _HEADER.pack(_PACKED, block.size) + packed
    return _HEADER.pack(_RAW, block.size) + raw


def decode_block(data: bytes) -> SingleArray:
    """Return the vector (n,) that `encode_block` was given, bit for bit; read-only."""
    packing, size = _HEADER.unpack_from(data)
    body = data[_HEADER.size :]
    values: SingleArray = np.frombuffer(zlib.decompress(body) if packing == _PACKED else body, dtype="<f4")
    if values.size != size:
        raise BadBlock(f"a stored block holds {values.size} numbers, its header says {size}")
    return values


def block_length(data: bytes) -> int:
    """Return the number of values of an encoded block without unpacking it."""
    return int(_HEADER.unpack_from(data)[1])


def checked_blocks(blocks: Mapping[str, npt.ArrayLike]) -> dict[str, SingleArray]:
    """Return the blocks as float32 vectors; BadBlock for what no distance can be taken of."""
    checked = {}
    for name, block in blocks.items():
        with np.errstate(over="ignore"):  # becomes infinity, which is refused below
            values = np.asarray(block, dtype=np.float32)
        if values.ndim != 1 or values.size == 0:
            raise BadBlock(f"block {name!r} is not a vector: its shape is {values.shape}")
        if not np.isfinite(values).all():
            raise BadBlock(f"block {name!r} holds NaN or infinity")
        checked[name] = values
    return checked
