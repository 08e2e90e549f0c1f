"""What an archive says of itself, and which parts it has."""

import json
from dataclasses import asdict
from typing import Any

import pytest

from index.errors import DamagedExport, NewerFormat
from service.backup.layout import FORMAT, Header, Part, file_member, part_of, table_member

HEADER = Header(
    format=FORMAT,
    faience="0.1.0",
    schema="0001",
    fingerprint="0123",
    exported_at="2026-01-01T00:00:00Z",
    counts={"shapes": 3},
)


def changed(**changes: Any) -> bytes:
    return json.dumps({**asdict(HEADER), **changes}).encode()


def test_a_header_comes_back() -> None:
    assert Header.from_bytes(HEADER.to_bytes()) == HEADER


def test_a_newer_format_is_told_whatever_else_it_says() -> None:
    with pytest.raises(NewerFormat, match=f"reads up to {FORMAT}"):
        Header.from_bytes(changed(format=FORMAT + 1, surprise=True))


@pytest.mark.parametrize(
    "data", [b"", b"[]", b"\xff", changed(format="1"), changed(schema=1), changed(format=0), changed(more=1)]
)
def test_what_is_no_header_is_damage(data: bytes) -> None:
    with pytest.raises(DamagedExport, match=r"library\.json"):
        Header.from_bytes(data)


def test_parts_are_known_by_their_names() -> None:
    assert part_of("library.json") is Part.HEADER
    assert part_of(file_member("shapes/a/thumbnail.png")) is Part.FILE
    assert part_of(table_member("shapes")) is Part.TABLE
    assert part_of("SHA256SUMS") is Part.SUMS
    for name in ("", "library.json/", "/files/a", "./files/a", "tables/shapes.csv", "README"):
        with pytest.raises(DamagedExport, match="no part of an export"):
            part_of(name)
