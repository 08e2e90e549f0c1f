"""A row that was written as a line is read again, and nothing else is."""

import json
import math
from datetime import datetime
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from sqlalchemy import (
    JSON,
    BigInteger,
    Boolean,
    Column,
    Date,
    DateTime,
    Float,
    LargeBinary,
    MetaData,
    String,
    Table,
)

from index import portable
from index.portable import line_of, parse_object, readers_of, row_of

TABLE = Table(
    "things",
    MetaData(),
    Column("text", String(), nullable=False),
    Column("number", BigInteger()),
    Column("share", Float()),
    Column("truth", Boolean()),
    Column("data", LargeBinary()),
    Column("moment", DateTime()),
    Column("tree", JSON()),
)
WHOLE: dict[str, Any] = {
    "text": "é\n☃",
    "number": -(2**63),
    "share": 0.1,
    "truth": False,
    "data": b"\x00\xff",
    "moment": datetime(2026, 5, 4, 3, 2, 1, 999_999),  # noqa: DTZ001 - as databases hold it
    "tree": {"a": [1, None, "\ud83d"]},
}
JSONS = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False) | st.text(),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(), inner, max_size=3),
    max_leaves=8,
)
ROWS = st.fixed_dictionaries(
    {
        "text": st.text(st.characters(exclude_categories=["Cs"])),
        "number": st.none() | st.integers(-(2**63), 2**63 - 1),
        "share": st.none() | st.floats(allow_nan=False, allow_infinity=False),
        "truth": st.none() | st.booleans(),
        "data": st.none() | st.binary(),
        "moment": st.none() | st.datetimes(),
        "tree": JSONS,
    }
)


def read(**changes: Any) -> dict[str, Any]:
    told = {**json.loads(line_of(WHOLE)), **changes}
    return row_of(json.dumps(told).encode(), readers_of(TABLE))


@given(row=ROWS)
def test_every_row_comes_back(row: dict[str, Any]) -> None:
    line = line_of(row)
    assert line.count(b"\n") == 1
    assert row_of(line, readers_of(TABLE)) == row


def test_a_line_is_plain_ascii_with_moments_in_utc() -> None:
    line = line_of(WHOLE)
    assert line.isascii()
    assert json.loads(line)["moment"] == "2026-05-04T03:02:01.999999Z"


def test_a_type_that_nobody_thought_of_is_a_defect() -> None:
    with pytest.raises(TypeError, match="no way to read"):
        readers_of(Table("days", MetaData(), Column("day", Date())))


def test_moments_of_other_zones_become_utc() -> None:
    assert read(moment="2026-01-01T01:00:00+02:00")["moment"].isoformat() == "2025-12-31T23:00:00"
    assert read(moment="2026-01-01T01:00:00Z")["moment"].tzinfo is None


@pytest.mark.parametrize(
    "changes",
    [
        {"text": None},
        {"text": 1},
        {"text": "\udc00"},
        {"number": 1.0},
        {"number": "1"},
        {"number": 2**63},
        {"share": "0.1"},
        {"share": True},
        {"truth": 0},
        {"data": "*"},
        {"data": "QQ"},
        {"moment": "2026-01-01T00:00:00"},
        {"moment": "9999-12-31T23:59:59-01:00"},
        {"moment": 0},
        {"more": 1},
    ],
)
def test_other_types_and_columns_are_refused(changes: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match="column"):
        read(**changes)


@pytest.mark.parametrize(
    "text", [b"", b"[]", b"1", b"{", b'{"a":Infinity}', b'{"a":' + b"[" * 200_000, b"\xff"]
)
def test_only_json_objects_are_taken(text: bytes) -> None:
    with pytest.raises(ValueError, match=r".+"):
        parse_object(text)


def test_what_could_not_be_read_again_is_not_written(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(ValueError, match="JSON"):
        line_of({"share": math.nan})
    monkeypatch.setattr(portable, "LONGEST_LINE", 10)
    with pytest.raises(ValueError, match="more than 10"):
        line_of({"text": "0123456789"})
