"""Rows as lines of JSON that any database could take: bytes in base64, moments as UTC text."""

import json
import math
from base64 import b64decode, b64encode
from collections.abc import Callable, Mapping
from datetime import UTC, datetime
from typing import Any

from sqlalchemy import JSON, Boolean, Column, DateTime, Float, Integer, LargeBinary, String, Table

LONGEST_LINE = 1 << 26  # bytes; what a table holds is shorter by far
_INTEGERS = 1 << 63

Row = Mapping[str, Any]
Reader = Callable[[Any], Any]  # what JSON holds → what the column takes; ValueError for anything else


def line_of(row: Row) -> bytes:
    """Return a row as a line; ValueError for one that is too long to be read again."""
    line = json.dumps({name: _told(value) for name, value in row.items()}, allow_nan=False).encode() + b"\n"
    if len(line) > LONGEST_LINE:
        raise ValueError(f"a row takes {len(line)} bytes, more than {LONGEST_LINE}")
    return line


def readers_of(table: Table) -> dict[str, Reader]:
    """Return how the values of each column are read."""
    return {column.name: _reader_of(column) for column in table.columns}


def row_of(line: bytes, readers: Mapping[str, Reader]) -> dict[str, Any]:
    """Return the row that a line holds, in the columns of ``readers``.

    Raises
    ------
    ValueError
        It is no JSON object, has other columns, or a value of another type; the message says which.
    """
    row = parse_object(line)
    if row.keys() != readers.keys():
        odd = ", ".join(sorted(row.keys() ^ readers.keys()))
        raise ValueError(f"its columns are not those of the table: {odd:.200}")
    return {name: _read(name, reader, row[name]) for name, reader in readers.items()}


def parse_object(text: bytes) -> dict[str, Any]:
    """Return a JSON object; ValueError for anything else, and for numbers that JSON does not have."""
    try:
        found = json.loads(text.decode(), parse_constant=_no_number)
    except RecursionError:
        raise ValueError("it is nested too deeply") from None
    if not isinstance(found, dict):
        raise ValueError("it is not a JSON object")
    return found


def _no_number(name: str) -> None:
    raise ValueError(f"{name} is not a number")


def _told(value: Any) -> Any:
    if isinstance(value, bytes):
        return b64encode(value).decode("ascii")
    if isinstance(value, datetime):
        return f"{value.isoformat()}Z"  # databases hold UTC without saying so
    return value


def _read(name: str, reader: Reader, value: Any) -> Any:
    try:
        return reader(value)
    except ValueError as error:
        raise ValueError(f"column {name!r}: {error}") from None


def _reader_of(column: Column[Any]) -> Reader:
    for kind, reader in _READERS:
        if isinstance(column.type, kind):
            return _required(reader) if not column.nullable else _optional(reader)
    raise TypeError(f"no way to read {column.type!r} of {column} from JSON")


def _required(reader: Reader) -> Reader:
    def read(value: Any) -> Any:
        if value is None:
            raise ValueError("a value was expected")
        return reader(value)

    return read


def _optional(reader: Reader) -> Reader:
    return lambda value: None if value is None else reader(value)


def _bytes(value: Any) -> bytes:
    return b64decode(_text(value), validate=True)


def _moment(value: Any) -> datetime:
    moment = datetime.fromisoformat(_text(value))
    if moment.tzinfo is None:
        raise ValueError("a moment needs its time zone")
    try:
        return moment.astimezone(UTC).replace(tzinfo=None)
    except OverflowError:
        raise ValueError(f"{value} lies before the first year or after the last") from None


def _truth(value: Any) -> bool:
    if not isinstance(value, bool):
        raise ValueError(f"expected true or false, got {value!r:.50}")
    return value


def _integer(value: Any) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or not -_INTEGERS <= value < _INTEGERS:
        raise ValueError(f"expected a whole number of 64 bits, got {value!r:.50}")
    return value


def _number(value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise ValueError(f"expected a number, got {value!r:.50}")
    return float(value)


def _text(value: Any) -> str:
    if not isinstance(value, str):
        raise ValueError(f"expected text, got {value!r:.50}")
    value.encode()  # half a surrogate pair is no text; a ValueError too
    return value


_READERS: list[tuple[type[Any], Reader]] = [
    (JSON, lambda value: value),
    (LargeBinary, _bytes),
    (DateTime, _moment),
    (Boolean, _truth),
    (Integer, _integer),
    (Float, _number),
    (String, _text),
]
