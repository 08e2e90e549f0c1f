"""Damage to text: numbers, words and lines."""

import re
from random import Random

_NUMBER = re.compile(rb"[-+]?\.?\d[\d.eE+-]*")
_WORD = re.compile(rb"\S+")
_FARTHEST = 4_000  # bytes that are searched for the next number or word
_EDGES = (
    0,
    1,
    2,
    3,
    127,
    128,
    255,
    256,
    32_767,
    65_535,
    65_536,
    2**31 - 1,
    2**31,
    2**32,
    2**53,
    2**63,
    2**64,
)
NUMBERS = (
    *(str(sign * edge).encode() for edge in _EDGES for sign in (1, -1)),
    *(
        b"1e308",
        b"1e999",
        b"-1e999",
        b"1e-320",
        b"9e99",
        b"1e100",
        b"nan",
        b"-inf",
        b"1.#IND",
        b"",
        b"-",
        b"+",
    ),
    *(b"9" * 400, b"0." + b"0" * 400 + b"1", b"1e" + b"9" * 30, b"0x10", b"1_0", b"--1", b"1.2.3", b"1,5"),
    *(
        b"1/2/3",
        b"1/2/3/4",
        b"1//",
        b"//",
        b"/1",
        b"1/",
        b"-0",
        b"0/0",
        b"\xd9\xa3",
        b"1\0",
        b"\x001",
        b"1e+",
    ),
)
WORDS = (
    *(
        b"v",
        b"vt",
        b"vn",
        b"vp",
        b"f",
        b"l",
        b"g",
        b"o",
        b"s",
        b"#",
        b"\\",
        b"usemtl",
        b"mtllib",
        b"usemtl a",
    ),
    *(
        b"newmtl",
        b"Kd",
        b"map_Kd",
        b"-s",
        b"-o",
        b"-mm",
        b"Tr",
        b"../a.png",
        b"/dev/zero",
        b"C:\\a.png",
        b"a.png",
    ),
    *(
        b"ply",
        b"format",
        b"ascii",
        b"binary_little_endian",
        b"binary_big_endian",
        b"1.0",
        b"element",
        b"face",
    ),
    *(
        b"vertex",
        b"property",
        b"list",
        b"end_header",
        b"char",
        b"uchar",
        b"short",
        b"ushort",
        b"int",
        b"uint",
    ),
    *(
        b"float",
        b"double",
        b"x",
        b"y",
        b"z",
        b"red",
        b"s",
        b"t",
        b"vertex_indices",
        b"vertex_index",
        b"texcoord",
    ),
    *(
        b"texnumber",
        b"tristrips",
        b"comment",
        b"TextureFile",
        b"obj_info",
        b"\xef\xbb\xbf",
        b"\xff\xfe",
        b"\x0c",
    ),
)


def change_number(data: bytes, rng: Random) -> bytes:
    """Write another number, or none, in the place of one."""
    return _replaced(_NUMBER, data, rng.choice(NUMBERS), rng)


def change_word(data: bytes, rng: Random) -> bytes:
    """Write a word that means something in the place of another."""
    return _replaced(_WORD, data, rng.choice(WORDS), rng)


def insert_word(data: bytes, rng: Random) -> bytes:
    """Put a number or a word between two others."""
    word = rng.choice((rng.choice(NUMBERS), rng.choice(WORDS)))
    return _replaced(re.compile(rb"(?<=\s)"), data, word + rng.choice((b" ", b"\n", b"\t", b"\r")), rng)


def remove_line(data: bytes, rng: Random) -> bytes:
    """Take a line out."""
    start, end = _line(data, rng)
    return data[:start] + data[end:]


def repeat_line(data: bytes, rng: Random) -> bytes:
    """Write a line several times."""
    start, end = _line(data, rng)
    return data[:end] + data[start:end] * rng.choice((1, 2, 50)) + data[end:]


def move_line(data: bytes, rng: Random) -> bytes:
    """Write a line before another one."""
    start, end = _line(data, rng)
    rest = data[:start] + data[end:]
    place, _ = _line(rest, rng)
    return rest[:place] + data[start:end] + rest[place:]


def join_lines(data: bytes, rng: Random) -> bytes:
    """Write a blank, or another kind of line end, in the place of one or of all."""
    new = rng.choice((b" ", b"", b"\r", b"\r\n", b"\n\n", b"\\\n", b"\x0b", b"\xc2\x85"))
    if rng.random() < 0.5:
        return data.replace(b"\n", new)
    _, end = _line(data, rng)
    return data[: end - 1] + new + data[end:]


def in_header(data: bytes, rng: Random) -> bytes:
    """Damage the header of a PLY file, whose body goes on as it was."""
    end = data.find(b"end_header")
    if end < 0:
        return data
    change = rng.choice((change_number, change_word, insert_word, remove_line, repeat_line, move_line))
    return change(data[:end], rng) + data[end:]


def _replaced(pattern: re.Pattern[bytes], data: bytes, new: bytes, rng: Random) -> bytes:
    start = rng.randrange(len(data) + 1)
    found = pattern.search(data, start, start + _FARTHEST) or pattern.search(data, 0, _FARTHEST)
    return data if found is None else data[: found.start()] + new + data[found.end() :]


def _line(data: bytes, rng: Random) -> tuple[int, int]:
    """Return where a random line starts, and where the next one does."""
    place = rng.randrange(len(data) + 1)
    end = data.find(b"\n", place)
    return data.rfind(b"\n", 0, place) + 1, len(data) if end < 0 else end + 1
