"""The corners of OBJ faces, “v”, “v/vt”, “v//vn” and “v/vt/vn”, read at once."""

from dataclasses import dataclass

import numpy as np

from worker.arrays import BoolArray, IntArray
from worker.errors import Code, MeshError
from worker.reading.parsing import parse_integers
from worker.reading.showing import shown
from worker.reading.words import Words


@dataclass(frozen=True, kw_only=True, eq=False)
class Corners:
    """Corners as written: counted from 1, or backwards from -1."""

    vertices: IntArray  # (k,)
    uvs: IntArray  # (k,)
    has_uv: BoolArray  # (k,), a texture coordinate is named
    counts: IntArray  # (f,), corners of each face


def read_corners(words: Words, face_lines: IntArray) -> Corners:
    """Read the corners of faces.

    Parameters
    ----------
    words : Words
        k words, all corners.
    face_lines : IntArray
        (f,) line numbers of the faces, ascending.

    Raises
    ------
    MeshError
        BAD_NUMBER, or BAD_DATA for more than three numbers in a corner.
    """
    first, second, third = _slashes(words)
    if (third < words.ends).any():
        position = int(np.argmax(third < words.ends))
        raise MeshError(
            Code.BAD_DATA,
            f"Line {words.lines[position]}: expected at most three numbers in a corner, "
            f"found {shown(words.word(position), 40)}.",
        )
    uv_starts = np.minimum(first + 1, words.ends)
    uv_words = Words(text=words.text, starts=uv_starts, ends=second, lines=words.lines)
    vertex_words = Words(text=words.text, starts=words.starts, ends=first, lines=words.lines)
    return Corners(
        vertices=parse_integers(vertex_words),
        uvs=parse_integers(uv_words),
        has_uv=second > uv_starts,
        counts=np.bincount(np.searchsorted(face_lines, words.lines), minlength=face_lines.size),
    )


def _slashes(words: Words) -> tuple[IntArray, IntArray, IntArray]:
    """Return where the first three slashes of each word are, (k,) each; its end where it has fewer."""
    places = np.append(np.flatnonzero(words.text == ord("/")), [words.text.size] * 3)
    next_place = np.searchsorted(places[:-3], words.starts)  # (k,)
    first, second, third = (np.minimum(places[next_place + number], words.ends) for number in range(3))
    return first, second, third
