"""Damage to zips and images in the places that count: the fields of their headers."""

import io
import re
import struct
import zipfile
import zlib
from collections.abc import Mapping
from random import Random

from soak.fuzzing.damage import BOUNDARIES
from soak.fuzzing.written import archive

# Signatures of a zip's records with the place and width of each field behind them.
_ENTRY = (
    (6, 2),
    (8, 2),
    (10, 2),
    (16, 4),
    (20, 4),
    (24, 4),
    (28, 2),
    (30, 2),
    (32, 2),
    (34, 2),
    (38, 4),
    (42, 4),
)
_LOCAL = ((4, 2), (6, 2), (8, 2), (14, 4), (18, 4), (22, 4), (26, 2), (28, 2))
_END = ((4, 2), (6, 2), (8, 2), (10, 2), (12, 4), (16, 4), (20, 2))
_RECORDS = {b"PK\x01\x02": _ENTRY, b"PK\x03\x04": _LOCAL, b"PK\x05\x06": _END}
_PNG = b"\x89PNG\r\n\x1a\n"
_CHUNKS = (
    b"IHDR",
    b"PLTE",
    b"tRNS",
    b"iCCP",
    b"zTXt",
    b"tEXt",
    b"iTXt",
    b"acTL",
    b"fcTL",
    b"fdAT",
    b"IDAT",
    b"eXIf",
)
_SIDES = (0, 1, 7, 9, 2**15, 2**16, 6_000, 2**31 - 1, 2**31, 2**32 - 1)


def change_zip_field(data: bytes, rng: Random) -> bytes:
    """Write a number at the edge of its type into a record of a zip."""
    signature = rng.choice(list(_RECORDS))
    starts = [found.start() for found in re.finditer(re.escape(signature), data)]
    if not starts:
        return data
    offset, width = rng.choice(_RECORDS[signature])
    place = rng.choice(starts) + offset
    near = int.from_bytes(data[place : place + width], "little") + rng.choice((-1, 1, 9))
    number = rng.choice((rng.choice(BOUNDARIES), near)) % (1 << 8 * width)
    return data[:place] + number.to_bytes(width, "little") + data[place + width :]


def members(data: bytes) -> Mapping[str, bytes]:
    """Return what a whole zip holds, nothing of a damaged one."""
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as zipped:
            small = [entry for entry in zipped.infolist() if entry.file_size < 2**20]
            return {entry.filename: zipped.read(entry) for entry in small}
    except (zipfile.BadZipFile, zlib.error, OSError, ValueError, RuntimeError, NotImplementedError, EOFError):
        return {}


def pack(files: Mapping[str, bytes], rng: Random) -> bytes:
    """Return a zip whose files are whole, so that what is damaged in them is reached."""
    # Half characters and what follows a zero byte cannot be written into a zip's list.
    writable = {name.partition("\0")[0].encode("utf-8", "replace").decode(): files[name] for name in files}
    return archive(writable, rng.choice((zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)))


def change_png_chunk(data: bytes, rng: Random) -> bytes:
    """Change one chunk of a PNG; its checksum is right again, so that what it says is believed."""
    chunks = _chunks(data)
    if not chunks:
        return data
    place = rng.randrange(len(chunks))
    kind, body = chunks[place]
    match rng.randrange(6):
        case 0:
            chunks[0] = (chunks[0][0], _resized(chunks[0][1], rng))
        case 1:
            chunks[place] = (rng.choice(_CHUNKS), body)
        case 2:
            del chunks[place]
        case 3:
            chunks.insert(
                place, (rng.choice(_CHUNKS), rng.choice((body, b"", rng.randbytes(30), bytes(900))))
            )
        case 4:
            chunks[place] = (kind, _noise(body, rng))
        case _:
            chunks.insert(place, (rng.choice((b"zTXt", b"iCCP")), b"a\0\0" + zlib.compress(bytes(3_000_000))))
    written = _PNG + b"".join(_chunk(kind, body) for kind, body in chunks)
    return written if rng.random() < 0.9 else _with_length(written, rng)


def change_jpeg_field(data: bytes, rng: Random) -> bytes:
    """Change the length or the size in a marker of a JPEG, or its kind."""
    markers = [found.start() for found in re.finditer(rb"\xff[\xc0-\xfe]", data)]
    if not markers:
        return data
    place = rng.choice(markers) + rng.choice((1, 2, 5, 7))
    number = rng.choice(BOUNDARIES) % 65_536
    return data[:place] + number.to_bytes(2, "big") + data[place + 2 :]


def _chunks(data: bytes) -> list[tuple[bytes, bytes]]:
    """Return kinds and bodies as far as they are whole."""
    place, found = len(_PNG), []
    while data.startswith(_PNG) and place + 12 <= len(data):
        (length,) = struct.unpack_from(">I", data, place)
        found.append((data[place + 4 : place + 8], data[place + 8 : place + 8 + length]))
        place += 12 + length
    return found


def _chunk(kind: bytes, body: bytes) -> bytes:
    return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))


def _resized(header: bytes, rng: Random) -> bytes:
    """Change width, height, depth, colour type or interlacing."""
    if rng.random() < 0.5:
        place = rng.choice((0, 4))
        return header[:place] + struct.pack(">I", rng.choice(_SIDES)) + header[place + 4 :]
    place = rng.randrange(8, 13)
    return header[:place] + bytes([rng.choice((0, 1, 2, 3, 4, 6, 8, 16, 255))]) + header[place + 1 :]


def _noise(body: bytes, rng: Random) -> bytes:
    if not body:
        return rng.randbytes(4)
    place = rng.randrange(len(body))
    return body[:place] + rng.randbytes(1) + body[place + 1 :]


def _with_length(written: bytes, rng: Random) -> bytes:
    """Let a chunk announce another length than it has."""
    starts = [found.start() - 4 for found in re.finditer(b"|".join(_CHUNKS), written)]
    place = rng.choice(starts) if starts else 8
    return written[:place] + struct.pack(">I", rng.choice(_SIDES)) + written[place + 4 :]
