"""The lines of an OBJ file by kind, a block at a time, with little Python by line."""

from dataclasses import dataclass

import numpy as np

from worker.arrays import BoolArray, FloatArray, IntArray
from worker.errors import Code, MeshError
from worker.reading import plain_text
from worker.reading.mtl import decode_text
from worker.reading.obj_corners import Corners, read_corners
from worker.reading.parsing import parse_floats
from worker.reading.words import Words, split_words

_KNOWN = {b"v", b"vt", b"vn", b"vp", b"f", b"fo", b"l", b"p", b"o", b"g", b"s", b"mtllib", b"usemtl"}
_PLAIN = {  # words that stand for all lines of a kind
    b"v": plain_text.VERTEX,
    b"vt": plain_text.UV,
    b"f": plain_text.FACE,
    b"usemtl": plain_text.MATERIAL,
    b"mtllib": plain_text.LIBRARY,
    b"o": plain_text.OTHER,
    b"#": plain_text.COMMENT,
}


@dataclass(frozen=True, kw_only=True, eq=False)
class Block:
    """What a piece of an OBJ file holds."""

    positions: FloatArray  # (n, 3)
    colours: FloatArray  # (n, 3), as written; NaN where a vertex has none
    uvs: FloatArray  # (t, 2)
    corners: Corners  # of the faces
    vertices_before: IntArray  # (f,), vertices of the block above each face
    uvs_before: IntArray  # (f,), the same for texture coordinates
    materials: tuple[str, ...]  # what stands after each usemtl
    material_of: IntArray  # (f,), index into materials, or -1: the last one before this block
    libraries: tuple[str, ...]  # what stands after each mtllib
    keywords: frozenset[bytes]  # the lines' first words, cut to 8 bytes


@dataclass(frozen=True, kw_only=True, eq=False)
class _Lines:
    """Words by line."""

    words: Words  # (k,)
    firsts: IntArray  # (l,), the word that begins each line that is not blank
    line_of: IntArray  # (k,), index into firsts
    kinds: IntArray  # (l,), a number for each keyword
    numbers: dict[bytes, int]  # the number of each keyword
    argument: BoolArray  # (k,), neither a keyword nor in a comment

    def of(self, keyword: bytes) -> BoolArray:
        """Return which lines have the keyword: (l,)."""
        found: BoolArray = self.kinds == self.numbers.get(keyword, -1)
        return found


def read_block(text: bytes, first_line: int) -> Block:
    """Read whole lines of an OBJ file.

    Raises
    ------
    MeshError
        BAD_NUMBER, BAD_DATA
    """
    return read_plain(text) or read_any(text, first_line)


def read_plain(text: bytes) -> Block | None:
    """Read lines as `read_any` does, ten times as fast, or None where one of them is unusual."""
    lines = plain_text.room_for(len(text))
    if not plain_text.scan_obj(np.frombuffer(text, dtype=np.uint8), lines):
        return None
    kinds = lines.kinds.tolist()
    corners = lines.corners[: kinds[plain_text.NONE]]
    counts, vertices_before, uvs_before, materials = lines.faces[: kinds[plain_text.FACE]].T.copy()
    named = lines.names[: kinds[plain_text.MATERIAL] + kinds[plain_text.LIBRARY]]
    vertices = lines.vertices[: kinds[plain_text.VERTEX]].copy()
    return Block(
        positions=vertices[:, :3],
        colours=vertices[:, 3:],
        uvs=lines.uvs[: kinds[plain_text.UV]].copy(),
        corners=Corners(
            vertices=corners[:, 0].copy(), uvs=corners[:, 1].copy(), has_uv=corners[:, 1] != 0, counts=counts
        ),
        vertices_before=vertices_before,
        uvs_before=uvs_before,
        materials=_rests(text, named[named[:, 0] == plain_text.MATERIAL, 1]),
        material_of=materials - 1,
        libraries=_rests(text, named[named[:, 0] == plain_text.LIBRARY, 1]),
        keywords=frozenset(word for word, kind in _PLAIN.items() if kinds[kind]),
    )


def read_any(text: bytes, first_line: int) -> Block:
    """Read lines of every form, and name the one that cannot be read."""
    lines = _split_lines(text, first_line)
    vertex, uv, face = lines.of(b"v"), lines.of(b"vt"), lines.of(b"f")
    vertices = _rows(lines, vertex, least=3, most=6, absent=np.nan)
    faces = np.flatnonzero(face)
    material_lines = np.flatnonzero(lines.of(b"usemtl"))
    words = lines.words
    return Block(
        positions=vertices[:, :3],
        colours=vertices[:, 3:],
        uvs=_rows(lines, uv, least=1, most=2, absent=0.0),
        corners=read_corners(words[lines.argument & face[lines.line_of]], words.lines[lines.firsts[faces]]),
        vertices_before=np.cumsum(vertex, dtype=np.int64)[faces],
        uvs_before=np.cumsum(uv, dtype=np.int64)[faces],
        materials=_rests(text, words.ends[lines.firsts[material_lines]]),
        material_of=np.searchsorted(material_lines, faces) - 1,
        libraries=_rests(text, words.ends[lines.firsts[lines.of(b"mtllib")]]),
        keywords=frozenset(lines.numbers),
    )


def is_obj(keywords: frozenset[bytes]) -> bool:
    """Return whether any line is one of an OBJ file."""
    return not _KNOWN.isdisjoint(keywords)


def _split_lines(text: bytes, first_line: int) -> _Lines:
    words = split_words(text, first_line)
    firsts = np.flatnonzero(np.diff(words.lines, prepend=-1))
    line_of = np.repeat(np.arange(firsts.size), np.diff(firsts, append=words.lines.size))
    kinds, numbers = _kinds(words, firsts)
    hashes = words.text[words.starts] == ord("#")
    seen = np.cumsum(hashes)  # (k,), words so far that begin a comment
    argument = seen == (seen - hashes)[firsts][line_of]
    argument[firsts] = False
    return _Lines(
        words=words,
        firsts=firsts,
        line_of=line_of,
        kinds=kinds,
        numbers=numbers,
        argument=argument,
    )


def _kinds(words: Words, firsts: IntArray) -> tuple[IntArray, dict[bytes, int]]:
    """Return a number for each line's keyword (l,), and the number of each keyword of up to 8 bytes."""
    lengths = np.minimum(words.ends - words.starts, 8)[firsts]
    keys = np.zeros((firsts.size, 8), dtype=np.uint8)
    for place in range(8):
        rows = np.flatnonzero(lengths > place)
        keys[rows, place] = words.text[words.starts[firsts[rows]] + place]
    found, kinds = np.unique(keys.view(np.uint64).reshape(-1), return_inverse=True)
    return kinds, {key.tobytes().rstrip(b"\0"): number for number, key in enumerate(found)}


def _rows(lines: _Lines, chosen: BoolArray, *, least: int, most: int, absent: float) -> FloatArray:
    """Return the numbers of the chosen lines (l,), `absent` where a line has fewer: (n, most)."""
    rows = np.flatnonzero(chosen)
    picked = np.flatnonzero(lines.argument & chosen[lines.line_of])
    counts = np.bincount(lines.line_of[picked], minlength=chosen.size)[rows]  # (n,)
    if (counts < least).any():
        line = int(lines.words.lines[lines.firsts[rows[np.argmax(counts < least)]]])
        raise MeshError(Code.BAD_DATA, f"Line {line}: expected at least {least} numbers, found fewer.")
    values = parse_floats(lines.words[picked])
    starts = np.cumsum(counts) - counts
    table = np.full((rows.size, most), absent)
    for place in range(most):
        # Four or five numbers are a point and its weight: only with six does a colour follow.
        filled = np.flatnonzero(counts > place if place < 3 else counts >= most)
        table[filled, place] = values[starts[filled] + place]
    return table


def _rests(text: bytes, ends: IntArray) -> tuple[str, ...]:
    """Return what stands on the lines after keywords that end at the given places."""
    found = (text[end : _line_end(text, end)] for end in ends.tolist())
    return tuple(decode_text(rest).strip() for rest in found)


def _line_end(text: bytes, start: int) -> int:
    end = text.find(b"\n", start)
    return len(text) if end < 0 else end
