"""PLY bodies written as text: one row a line."""

import numpy as np

from worker.arrays import FloatArray, IntArray
from worker.errors import Code, MeshError
from worker.reading.numbers import parse_floats
from worker.reading.ply_columns import Body, Lists, Table, check_counts, positions
from worker.reading.ply_header import Element, Header
from worker.reading.words import blocks, split_words, with_line_feeds


def read_ascii(data: bytes, header: Header) -> Body:
    """Read the tables of a text file.

    Raises
    ------
    MeshError
        BAD_NUMBER, TRUNCATED, TRAILING_DATA, BAD_DATA
    """
    values, lengths = _read_rows(with_line_feeds(data[header.body :]))
    ends = np.cumsum(lengths)  # (n_rows,), in values
    body: Body = {}
    first = 0
    for element in header.elements:
        last = first + element.count
        if last > ends.size:
            raise _truncated(element, ends.size - first)
        rows = slice(first, last)
        body[element.name] = _read_table(
            values, ends[rows] - lengths[rows], ends[rows], element, last == ends.size
        )
        first = last
    if first < ends.size:
        raise MeshError(
            Code.TRAILING_DATA,
            f"The header announces {first:,} lines of data, but {ends.size:,} follow.",
        )
    return body


def _read_rows(text: bytes) -> tuple[FloatArray, IntArray]:
    """Return all numbers of the text (k,), and how many stand on each line that is not blank (n_rows,)."""
    values, lengths = [np.zeros(0)], [np.zeros(0, dtype=np.int64)]
    for block, line in blocks(text):
        words = split_words(block, line)
        values.append(parse_floats(words))
        firsts = np.flatnonzero(np.diff(words.lines, prepend=-1))
        lengths.append(np.diff(firsts, append=words.lines.size))
    return np.concatenate(values), np.concatenate(lengths)


def _read_table(
    values: FloatArray, starts: IntArray, ends: IntArray, element: Element, is_last: bool
) -> Table:
    """Read rows of which each is values[start:end]."""
    scalars, lists = {}, {}
    places = starts
    for field in element.properties:
        _check_rows(places < ends, element, is_last)
        if field.count_type is None:
            scalars[field.name] = _checked(values[places], field.type, element)
            places = places + 1
            continue
        counts = _whole(values[places], element)
        check_counts(counts, element.name)
        _check_rows(places + counts < ends, element, is_last)
        found = values[positions(places + 1, counts)]
        lists[field.name] = Lists(values=_checked(found, field.type, element), counts=counts)
        places = places + 1 + counts
    if (places != ends).any():
        row = int(np.argmax(places != ends))
        raise MeshError(
            Code.BAD_DATA, f"The {element.name} number {row + 1} has more numbers than the header announces."
        )
    return Table(scalars=scalars, lists=lists)


def _check_rows(enough: np.ndarray[tuple[int], np.dtype[np.bool_]], element: Element, is_last: bool) -> None:
    """Refuse rows with too few numbers; where only the file's last is short, the file was cut."""
    if enough.all():
        return
    if is_last and enough[:-1].all():
        raise _truncated(element, element.count - 1)
    row = int(np.argmin(enough))
    raise MeshError(
        Code.BAD_DATA, f"The {element.name} number {row + 1} has fewer numbers than it announces."
    )


def _whole(values: FloatArray, element: Element) -> IntArray:
    """Return list lengths; a count that is no whole number is refused, and so is one past any file."""
    if not (np.abs(values) < 2**53).all() or (values != np.floor(values)).any():
        raise MeshError(
            Code.BAD_DATA, f"A list of the {element.name} data has a length that is no whole number."
        )
    return values.astype(np.int64)


def _checked(values: FloatArray, kind: str, element: Element) -> FloatArray:
    """Refuse numbers that the declared type cannot hold."""
    if kind[0] == "f" or not values.size:
        return values
    bounds = np.iinfo(kind)
    wrong = ~((values >= bounds.min) & (values <= bounds.max) & (values == np.floor(values)))
    if wrong.any():
        raise MeshError(
            Code.BAD_DATA,
            f"The {element.name} data holds {values[np.argmax(wrong)]:g} where the header announces "
            f"whole numbers from {bounds.min} to {bounds.max}.",
        )
    return values


def _truncated(element: Element, whole: int) -> MeshError:
    return MeshError(
        Code.TRUNCATED,
        f"The file ends within the {element.name} data: {element.count:,} announced, {max(whole, 0):,} whole.",
    )
