"""Words become numbers: all at once where they are plain, one by one where something is odd."""

import re

import numpy as np

from worker.arrays import BoolArray, ByteArray, FloatArray, IntArray
from worker.errors import Code, MeshError
from worker.reading.showing import shown
from worker.reading.words import Words

_WHOLE = re.compile(r"[-+]?[0-9]{1,18}")  # longer ones could overflow 64 bits
_REAL = re.compile(r"[-+]?([0-9.]+([eE][-+]?[0-9]+)?|nan|inf(inity)?|1\.#\w+)", re.IGNORECASE | re.ASCII)


def _table(characters: bytes) -> BoolArray:
    table = np.zeros(256, dtype=np.bool_)
    table[list(characters)] = True
    return table


_PLAIN_WHOLE = _table(b"0123456789+- ")
_PLAIN_REAL = _table(b"0123456789+-.eE ")


def parse_floats(words: Words) -> FloatArray:
    """Read words as numbers.

    Parameters
    ----------
    words : Words
        k words; ``nan``, ``inf`` and the ``1.#IND`` of old Windows programs are numbers here.

    Returns
    -------
    FloatArray
        (k,)

    Raises
    ------
    MeshError
        BAD_NUMBER, naming the word and its line.
    """
    text = _plain_text(words, _PLAIN_REAL)
    if text is not None:
        try:
            values: FloatArray = np.fromstring(text, dtype=np.float64, sep=" ")
        except ValueError:
            values = np.zeros(0)  # the slow way names the word
        if values.size == words.starts.size:
            return values
    return np.array(
        [_parse_float(words, position) for position in range(words.starts.size)], dtype=np.float64
    )


def parse_integers(words: Words) -> IntArray:
    """Read words as whole numbers with an optional sign; an empty word is 0.

    Parameters
    ----------
    words : Words
        k words; those that end where they start are empty.

    Returns
    -------
    IntArray
        (k,)

    Raises
    ------
    MeshError
        BAD_NUMBER, naming the word and its line.
    """
    filled = np.flatnonzero(words.ends > words.starts)
    values = np.zeros(words.starts.size, dtype=np.int64)
    values[filled] = _parse_whole(words[filled])
    return values


def _parse_whole(words: Words) -> IntArray:
    text = _plain_text(words, _PLAIN_WHOLE)
    if text is not None and _are_plain(words):
        try:
            values: IntArray = np.fromstring(text, dtype=np.int64, sep=" ")
        except ValueError:
            values = np.zeros(0, dtype=np.int64)  # the slow way names the word
        if values.size == words.starts.size:
            return values
    return np.array(
        [_parse_integer(words, position) for position in range(words.starts.size)], dtype=np.int64
    )


def _are_plain(words: Words) -> bool:
    """Return whether no word is too long, or a sign alone, which numpy would take for 0."""
    last = words.text[words.ends - 1]
    return bool((words.ends - words.starts).max() <= 18 and (last >= ord("0")).all())


def _plain_text(words: Words, plain: BoolArray) -> str | None:
    """Return the words with blanks between them, or None where they hold other characters than plain ones."""
    if not words.starts.size:
        return None
    kept = _only(words)
    return kept.tobytes().decode("ascii") if plain[kept].all() else None


def _only(words: Words) -> ByteArray:
    """Return the text around the words with everything else blank."""
    first, last = int(words.starts[0]), int(words.ends[-1])
    steps = np.zeros(last - first + 1, dtype=np.int8)
    steps[words.starts - first] = 1
    steps[words.ends - first] -= 1
    inside = np.cumsum(steps[:-1], dtype=np.int8).view(np.bool_)
    kept: ByteArray = np.where(inside, words.text[first:last], np.uint8(ord(" ")))
    return kept


def _parse_float(words: Words, position: int) -> float:
    word = words.word(position)
    if _REAL.fullmatch(word) is None:
        raise _bad_number(words, position, "a number")
    try:
        return float("nan") if "#" in word else float(word)  # 1.#IND and 1.#INF are written by old programs
    except ValueError:
        raise _bad_number(words, position, "a number") from None


def _parse_integer(words: Words, position: int) -> int:
    word = words.word(position)
    if _WHOLE.fullmatch(word) is None:
        raise _bad_number(words, position, "a whole number")
    return int(word)


def _bad_number(words: Words, position: int, expected: str) -> MeshError:
    word = words.word(position)
    return MeshError(
        Code.BAD_NUMBER, f"Line {words.lines[position]}: expected {expected}, found {shown(word, 40)}."
    )
