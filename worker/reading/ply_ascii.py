"""PLY bodies written as text: one row a line."""

from dataclasses import dataclass

import numpy as np

from worker.arrays import BoolArray, FloatArray, IntArray
from worker.errors import Code, MeshError
from worker.reading.parsing import parse_floats
from worker.reading.ply_columns import Body, Lists, Table, check_counts, positions, truncated
from worker.reading.ply_header import Element, Header
from worker.reading.words import blocks, split_words, with_line_feeds


@dataclass(frozen=True, kw_only=True, eq=False)
class _Rows:
    """The lines of one element."""

    element: Element
    values: FloatArray  # (k,), all numbers of the file
    starts: IntArray  # (n,), where each line's first is
    ends: IntArray  # (n,), after its last
    cut: bool  # the last line is the file's last and does not end: it may be cut


def read_ascii(data: bytes, header: Header) -> Body:
    """Read the tables of a text file.

    Raises
    ------
    MeshError
        BAD_NUMBER, TRUNCATED, TRAILING_DATA, BAD_DATA
    """
    text = with_line_feeds(data[header.body :])
    values, lengths = _read_numbers(text)
    ends = np.cumsum(lengths)  # (n_lines,), in values
    body: Body = {}
    first = 0
    for element in header.elements:
        last = first + element.count
        if last > ends.size:
            raise truncated(element, ends.size - first)
        body[element.name] = _read_table(
            _Rows(
                element=element,
                values=values,
                starts=(ends - lengths)[first:last],
                ends=ends[first:last],
                cut=last == ends.size and not text.endswith(b"\n"),
            )
        )
        first = last
    if first < ends.size:
        raise MeshError(
            Code.TRAILING_DATA, f"The header announces {first:,} lines of data, but {ends.size:,} follow."
        )
    return body


def _read_numbers(text: bytes) -> tuple[FloatArray, IntArray]:
    """Return all numbers of the text (k,), and how many stand on each line that is not blank (n_lines,)."""
    values, lengths = [np.zeros(0)], [np.zeros(0, dtype=np.int64)]
    for block, line in blocks(text):
        words = split_words(block, line)
        values.append(parse_floats(words))
        firsts = np.flatnonzero(np.diff(words.lines, prepend=-1))
        lengths.append(np.diff(firsts, append=words.lines.size))
    return np.concatenate(values), np.concatenate(lengths)


def _read_table(rows: _Rows) -> Table:
    scalars: dict[str, FloatArray] = {}
    lists: dict[str, Lists] = {}
    places = rows.starts  # (n,), of the next number in each line
    for field in rows.element.properties:
        _check_enough(rows, places < rows.ends)
        if field.count_type is None:
            scalars[field.name] = _checked(rows.values[places], field.type, rows.element)
            places = places + 1
            continue
        counts = _checked(rows.values[places], field.count_type, rows.element).astype(np.int64)
        check_counts(counts, rows.element)
        _check_enough(rows, places + counts < rows.ends)
        found = rows.values[positions(places + 1, counts)]
        lists[field.name] = Lists(values=_checked(found, field.type, rows.element), counts=counts)
        places = places + 1 + counts
    return Table(scalars=_trusted(rows, scalars, rows.ends - places), lists=lists)


def _trusted(rows: _Rows, scalars: dict[str, FloatArray], extra: IntArray) -> dict[str, FloatArray]:
    """Refuse lines with numbers to spare, but for those that MeshLab once wrote.

    It announced a face's colour as four numbers and wrote a list: then every line has as many too
    many, and the numbers after the lists mean nothing.
    """
    if not extra.any():
        return scalars
    if rows.element.name == "face" and extra.size > 1 and (extra == extra[0]).all():
        return {}
    row = int(np.argmax(extra != 0))
    raise MeshError(
        Code.BAD_DATA, f"The {rows.element.name} number {row + 1} has more numbers than the header announces."
    )


def _check_enough(rows: _Rows, enough: BoolArray) -> None:
    """Refuse lines with too few numbers."""
    if enough.all():
        return
    if rows.cut and enough[:-1].all():
        raise truncated(rows.element, rows.element.count - 1)
    row = int(np.argmin(enough))
    raise MeshError(
        Code.BAD_DATA, f"The {rows.element.name} number {row + 1} has fewer numbers than it announces."
    )


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
