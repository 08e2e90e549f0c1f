"""Plain OBJ lines, read byte by byte; whatever is odd is left to the readers that explain it."""

from typing import NamedTuple

import numpy as np

from worker.arrays import ByteArray, FloatArray, IntArray
from worker.compiled import compiled
from worker.reading.decimals import read_decimal, read_whole

MINUS, SLASH, HASH = b"-/#"
LETTER_F, LETTER_G, LETTER_N, LETTER_O, LETTER_S, LETTER_T, LETTER_V = b"fgnostv"

NONE, OTHER, VERTEX, UV, FACE, MATERIAL, LIBRARY, COMMENT = range(8)  # kinds of lines


class PlainLines(NamedTuple):
    """What the lines of a piece of an OBJ file hold, in arrays that are filled from the start."""

    vertices: FloatArray  # (n, 6), positions and colours; NaN where there is no colour
    uvs: FloatArray  # (n, 2)
    corners: IntArray  # (k, 2), vertex and texture coordinate as written; 0 where none is
    faces: IntArray  # (f, 4): corners; vertices, uvs and materials above it
    names: IntArray  # (l, 2): kind, and where the keyword ends, of lines with a name
    kinds: IntArray  # (8,), lines of each kind; NONE counts corners


def room_for(n_bytes: int) -> PlainLines:
    """Return arrays that hold whatever so many bytes of text can say."""
    size = n_bytes + 1  # the last line may lack its end
    return PlainLines(
        vertices=np.empty((size // len("v 0 0 0;") + 1, 6)),
        uvs=np.empty((size // len("vt 0;") + 1, 2)),
        corners=np.empty((size // len("1;") + 1, 2), dtype=np.int64),
        faces=np.empty((size // len("f;") + 1, 4), dtype=np.int64),
        names=np.empty((size // len("usemtl;") + 1, 2), dtype=np.int64),
        kinds=np.zeros(8, dtype=np.int64),
    )


@compiled
def scan_obj(text: ByteArray, lines: PlainLines) -> bool:
    """Read whole lines of an OBJ file; return whether all of them are plain.

    Parameters
    ----------
    text : (n,) array
        Lines that end with a line feed.
    lines : PlainLines
        To be filled.
    """
    at, size = 0, len(text)
    while at < size:
        at = _skip_blanks(text, at)
        if at >= size:
            break
        if text[at] == 10:
            at += 1
            continue
        end = _word_end(text, at)
        kind = _kind(text, at, end)
        if kind == VERTEX:
            at = _read_row(text, end, lines.vertices[lines.kinds[VERTEX]], 3, np.nan)
        elif kind == UV:
            at = _read_row(text, end, lines.uvs[lines.kinds[UV]], 1, 0.0)
        elif kind == FACE:
            at = _read_face(text, end, lines)
        elif kind == NONE:
            return False
        else:
            if kind in (MATERIAL, LIBRARY):
                place = lines.kinds[MATERIAL] + lines.kinds[LIBRARY]
                lines.names[place, 0], lines.names[place, 1] = kind, end
            at = _line_end(text, end)
        if at < 0:
            return False
        lines.kinds[kind] += 1
    return True


@compiled
def _skip_blanks(text: ByteArray, at: int) -> int:
    while at < len(text) and (text[at] == 32 or (text[at] != 10 and 9 <= text[at] <= 13)):
        at += 1
    return at


@compiled
def _word_end(text: ByteArray, at: int) -> int:
    while at < len(text) and text[at] != 32 and not 9 <= text[at] <= 13:
        at += 1
    return at


@compiled
def _line_end(text: ByteArray, at: int) -> int:
    while at < len(text) and text[at] != 10:
        at += 1
    return at


@compiled
def _kind(text: ByteArray, start: int, end: int) -> int:
    """Tell a line by its first word; NONE for those that are left to others."""
    first, length = text[start], end - start
    if first == HASH:
        return COMMENT
    if length == 1:
        if first == LETTER_V:
            return VERTEX
        if first == LETTER_F:
            return FACE
        return OTHER if first in (LETTER_O, LETTER_G, LETTER_S) else NONE
    if length == 2 and first == LETTER_V:
        second = text[start + 1]
        return UV if second == LETTER_T else OTHER if second == LETTER_N else NONE
    if length == 6 and _is(text, start, b"usemtl"):
        return MATERIAL
    return LIBRARY if length == 6 and _is(text, start, b"mtllib") else NONE


@compiled
def _is(text: ByteArray, start: int, word: bytes) -> bool:
    same = True
    for place in range(len(word)):
        same = same and text[start + place] == word[place]
    return same


@compiled
def _read_row(text: ByteArray, at: int, row: FloatArray, least: int, absent: float) -> int:
    """Read the numbers of a line, as many as the row holds; return where it ends, −1 for an odd one."""
    count = 0
    at = _skip_blanks(text, at)
    while at < len(text) and text[at] != 10 and text[at] != HASH:
        value, at = read_decimal(text, at)
        if at < 0:
            return -1
        if count < len(row):
            row[count] = value
        count += 1
        at = _skip_blanks(text, at)
    if count < least:
        return -1
    if count < len(
        row
    ):  # four or five numbers are a point and its weight: only with six does a colour follow
        row[min(count, 3) if len(row) == 6 else count :] = absent
    return _line_end(text, at)


@compiled
def _read_face(text: ByteArray, at: int, lines: PlainLines) -> int:
    first = corner = lines.kinds[NONE]
    at = _skip_blanks(text, at)
    while at < len(text) and text[at] != 10 and text[at] != HASH:
        lines.corners[corner, 1] = 0
        lines.corners[corner, 0], at = read_whole(text, at)
        if at >= 0 and at < len(text) and text[at] == SLASH:
            at = _read_rest(text, at + 1, lines.corners[corner])
        if at < 0 or (at < len(text) and text[at] != 32 and not 9 <= text[at] <= 13):
            return -1
        corner += 1
        at = _skip_blanks(text, at)
    face = lines.faces[lines.kinds[FACE]]
    face[0], face[1], face[2], face[3] = (
        corner - first,
        lines.kinds[VERTEX],
        lines.kinds[UV],
        lines.kinds[MATERIAL],
    )
    lines.kinds[NONE] = corner
    return _line_end(text, at)


@compiled
def _read_rest(text: ByteArray, at: int, corner: IntArray) -> int:
    """Read what stands after the first slash of a corner; the number of a normal is not looked at."""
    if at < len(text) and text[at] != SLASH:
        corner[1], at = read_whole(text, at)
        if corner[1] == 0:
            return -1
    if at >= 0 and at < len(text) and text[at] == SLASH:
        at += 1
        while at < len(text) and (48 <= text[at] <= 57 or text[at] == MINUS):
            at += 1
    return at
