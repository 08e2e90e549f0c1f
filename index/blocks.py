"""Blocks as bytes: one a number where they are packed, else float32; by zlib where that is much shorter."""

import struct
import zlib
from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from index.arrays import SingleArray
from index.errors import BadBlock
from index.packing import PACKINGS, Packing

_HEADER = struct.Struct("<BI")  # kind, number of values
_UNIT = struct.Struct("<?d")  # of a packing, after the header: rows outlive the table
_CODES, _ZLIB = 2, 1  # bits of the kind: one byte a number, compressed
_LEVEL = 4  # of zlib; higher ones gain nothing on such data
_WORTH = 0.75  # of the length: unpacking takes longer than reading, so a few per cent are not worth it


def encode_block(name: str, block: SingleArray) -> bytes:
    """Return a block (n,) as bytes: a header, then its codes where `PACKINGS` has them, else float32."""
    packing = PACKINGS.get(name)
    if packing is None:
        kind, unit, raw = 0, b"", block.astype("<f4", copy=False).tobytes()
    else:
        kind, unit = _CODES, _UNIT.pack(packing.squared, packing.unit)
        raw = packing.pack(block).tobytes()
    compressed = zlib.compress(raw, _LEVEL)
    if len(compressed) < _WORTH * len(raw):
        kind, raw = kind | _ZLIB, compressed
    return _HEADER.pack(kind, block.size) + unit + raw


def decode_block(data: bytes) -> SingleArray:
    """Return a block (n,) as `index.packing.rounded` gives it, bit for bit; read-only."""
    kind, size = _HEADER.unpack_from(data)
    start = _HEADER.size + (_UNIT.size if kind & _CODES else 0)
    raw = data[start:]
    if kind & _ZLIB:
        raw = _decompressed(raw, size if kind & _CODES else 4 * size)
    values: SingleArray = _unpacked(data, raw) if kind & _CODES else np.frombuffer(raw, dtype="<f4")
    if values.size != size:
        raise BadBlock(f"a stored block holds {values.size} numbers, its header says {size}")
    return values


def _decompressed(data: bytes, size: int) -> bytes:
    """Return what was compressed; never much more than ``size`` bytes, whatever the data says."""
    stream = zlib.decompressobj()
    raw = stream.decompress(data, size + 1)
    if len(raw) != size or not stream.eof:
        raise BadBlock(f"a stored block does not unpack to the {size} bytes that its header asks for")
    return raw


def _unpacked(data: bytes, raw: bytes) -> SingleArray:
    squared, unit = _UNIT.unpack_from(data, _HEADER.size)
    values = Packing(squared=squared, unit=unit).unpack(np.frombuffer(raw, dtype=np.uint8))
    values.flags.writeable = False
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
