"""Words become numbers: all at once where they are plain, one by one where something is odd."""

import numpy as np

from worker.arrays import BoolArray, ByteArray, FloatArray, IntArray
from worker.errors import Code, MeshError
from worker.reading.words import Words

_DIGITS = 18  # longest whole number that is read: more could overflow 64 bits

_PLAIN = np.zeros(256, dtype=np.bool_)
_PLAIN[list(b"0123456789+-.eE \n")] = True


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
    if not words.starts.size:
        return np.zeros(0)
    kept = _only(words)
    if _PLAIN[kept].all():
        try:
            values: FloatArray = np.fromstring(kept.tobytes().decode("ascii"), dtype=np.float64, sep=" ")
        except ValueError:
            values = np.zeros(0)
        if values.size == words.starts.size:
            return values
    return np.array([_parse_float(words, position) for position in range(words.starts.size)])


def _only(words: Words) -> ByteArray:
    """Return the text around the words with everything else blank."""
    first, last = int(words.starts[0]), int(words.ends[-1])
    steps = np.zeros(last - first + 1, dtype=np.int8)
    steps[words.starts - first] = 1
    steps[words.ends - first] -= 1
    inside = np.cumsum(steps[:-1], dtype=np.int8).astype(np.bool_)
    kept: ByteArray = np.where(inside, words.text[first:last], np.uint8(ord(" ")))
    return kept


def _parse_float(words: Words, position: int) -> float:
    word = words.word(position)
    if "#" in word[1:]:  # 1.#INF, -1.#IND, 1.#QNAN
        return float("nan")
    try:
        if "_" in word or not word.isascii():
            raise ValueError
        return float(word)
    except ValueError:
        raise bad_number(word, int(words.lines[position]), "a number") from None


def bad_number(word: str, line: int, expected: str) -> MeshError:
    """Return the refusal of one word."""
    shown = word if len(word) <= 40 else word[:40] + "…"
    return MeshError(Code.BAD_NUMBER, f"Line {line}: expected {expected}, found “{shown}”.")


def parse_integers(words: Words) -> IntArray:
    """Read words as whole numbers with an optional sign; an empty word is 0.

    Parameters
    ----------
    words : Words
        k words; those whose end is their start are empty.

    Returns
    -------
    IntArray
        (k,)

    Raises
    ------
    MeshError
        BAD_NUMBER, naming the word and its line.
    """
    first = words.text[np.minimum(words.starts, words.text.size - 1)] if words.text.size else words.text
    filled = words.ends > words.starts
    negative = filled & (first == ord("-"))
    starts = words.starts + (negative | (filled & (first == ord("+"))))
    lengths = words.ends - starts
    bad = (filled & (lengths < 1)) | (lengths > _DIGITS)
    values = np.zeros(starts.size, dtype=np.int64)
    for place in range(min(int(lengths.max(initial=0)), _DIGITS)):
        rows = np.flatnonzero(lengths > place)
        digits = words.text[starts[rows] + place] - np.uint8(ord("0"))  # wraps below "0" to over 9
        bad[rows] |= digits > 9
        values[rows] = values[rows] * 10 + digits
    _refuse_first(words, bad)
    return np.where(negative, -values, values)


def _refuse_first(words: Words, bad: BoolArray) -> None:
    if bad.any():
        position = int(np.argmax(bad))
        raise bad_number(words.word(position), int(words.lines[position]), "a whole number")
