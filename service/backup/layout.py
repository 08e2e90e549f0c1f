"""What an exported library consists of, and what it says of itself."""

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from enum import IntEnum

from index.errors import DamagedExport, NewerFormat
from index.portable import parse_object

FORMAT = 1  # raised when an older version could not read what is written
HEADER, SUMS = "library.json", "SHA256SUMS"
FILES, TABLES, ROWS = "files/", "tables/", ".jsonl"
LONGEST_HEADER = 1 << 20  # bytes


class Part(IntEnum):
    """The parts of an export, in their order."""

    HEADER = 0
    FILE = 1
    TABLE = 2
    SUMS = 3


@dataclass(frozen=True, kw_only=True)
class Header:
    """What an export says of itself."""

    format: int
    faience: str  # version that made it
    schema: str  # migration that its tables have
    fingerprint: str  # of that version's parameters
    exported_at: str  # RFC 3339
    counts: Mapping[str, int]  # rows of each table, before anything was left out

    def to_bytes(self) -> bytes:
        """Write it for people, too."""
        return json.dumps(asdict(self), indent=1).encode() + b"\n"

    @classmethod
    def from_bytes(cls, data: bytes) -> "Header":
        """Read it.

        Raises
        ------
        NewerFormat
            This version cannot know what else it says.
        DamagedExport
        """
        try:
            told = parse_object(data)
        except ValueError as error:
            raise DamagedExport(f"{HEADER} cannot be read: {error}") from None
        if not isinstance(told.get("format"), int) or not isinstance(told.get("schema"), str):
            raise DamagedExport(f"{HEADER} must tell the format (a number) and the schema (text)")
        if told["format"] > FORMAT:
            raise NewerFormat(
                f"the export has the format {told['format']}, this version of Faience reads up to {FORMAT};"
                " update Faience first"
            )
        if told.keys() != cls.__dataclass_fields__.keys() or told["format"] != FORMAT:
            raise DamagedExport(f"{HEADER} does not have the fields of the format {FORMAT}")
        return cls(**told)


def file_member(key: str) -> str:
    """Return the name under which a file of the store is exported."""
    return FILES + key


def table_member(table: str) -> str:
    """Return the name under which a table is exported."""
    return f"{TABLES}{table}{ROWS}"


def part_of(name: str) -> Part:
    """Return which part of an export a member is; DamagedExport for what is none."""
    if name == HEADER:
        return Part.HEADER
    if name == SUMS:
        return Part.SUMS
    if name.startswith(FILES):
        return Part.FILE
    if name.startswith(TABLES) and name.endswith(ROWS):
        return Part.TABLE
    raise DamagedExport(f"the member {name!r:.100} is no part of an export")
