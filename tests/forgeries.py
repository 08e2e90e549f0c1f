"""What no export could hold: each a change of an honest archive, with the reason that is told."""

import json
from collections.abc import Callable

from tests.backups import Parts, edited

Change = Callable[[Parts], Parts | None]
STATE, SHAPES, FILES = "tables/state.jsonl", "tables/shapes.jsonl", "tables/files.jsonl"
BLOCKS, WORDS = "tables/plain_blocks.jsonl", "tables/quantised_blocks.jsonl"


def first_file(parts: Parts) -> str:
    return next(name for name in parts if name.startswith("files/"))


def renamed(parts: Parts, old: str, new: str) -> Parts:
    return {new if name == old else name: data for name, data in parts.items()}


def row_change(table: str, /, **changes: object) -> Change:
    def change(parts: Parts) -> None:
        parts[table] = edited(parts[table], 0, **changes)

    return change


def appended(table: str, line: bytes) -> Change:
    def change(parts: Parts) -> None:
        parts[table] += line + b"\n"

    return change


def first_row_again(table: str) -> Change:
    def change(parts: Parts) -> None:
        parts[table] += parts[table].splitlines(keepends=True)[0]

    return change


def without(name: str) -> Change:
    return lambda parts: {each: data for each, data in parts.items() if each != name}


def moved_file(key: str) -> Change:
    return lambda parts: renamed(parts, first_file(parts), f"files/{key}")


def added(name: str, data: bytes = b"x") -> Change:
    return lambda parts: {**parts, name: data}


def one_key_for_two(parts: Parts) -> None:
    key = json.loads(parts[FILES].splitlines()[0])["key"]
    parts[FILES] = edited(parts[FILES], 1, key=key)


def header(**changes: object) -> Change:
    def change(parts: Parts) -> None:
        parts["library.json"] = json.dumps({**json.loads(parts["library.json"]), **changes}).encode()

    return change


def file_below_a_file(parts: Parts) -> Parts:
    name = next(name for name in parts if name.startswith("files/shapes/"))
    extra = {f"{name}/below": b"x"}
    return {"library.json": parts["library.json"], name: parts[name], **extra, **parts}


HOSTILE: dict[str, tuple[Change, str]] = {
    "a key that leads outside": (moved_file("../../outside"), "no key of ours"),
    "an absolute key": (moved_file("/etc/passwd"), "no key of ours"),
    "a key with a backslash": (moved_file("..\\outside"), "no key of ours"),
    "a hidden file": (moved_file("shapes/.incoming/x"), "no key of ours"),
    "an empty key": (moved_file(""), "no key of ours"),
    "a file that belongs to nobody": (moved_file("shapes/nobody/thumbnail.png"), "belongs to no shape"),
    "a file below another": (file_below_a_file, "no file can lie"),
    "a key of two shapes": (one_key_for_two, "two shapes claim"),
    "a member that is no part": (added("README"), "no part of an export"),
    "a table out of the schema": (
        added("tables/spies.jsonl", b"{}\n"),
        "'spies' that its schema",
    ),
    "the keys of the door": (added("tables/api_keys.jsonl", b""), "'api_keys' that its schema"),
    "Alembic's own table": (added("tables/alembic_version.jsonl", b""), "that its schema"),
    "a file after the tables": (added("files/shapes/x/y"), "wrong place"),
    "a second header": (lambda parts: {**parts, "library.json ": b""}, "no part of an export"),
    "a missing table": (without("tables/tombstones.jsonl"), "lacks the tables tombstones"),
    "no header": (without("library.json"), "does not begin with library.json"),
    "an unknown column": (row_change(SHAPES, spy=1), "its columns are not those of the table: spy"),
    "a missing column": (appended(SHAPES, b"{}"), "its columns are not those"),
    "text for a number": (row_change(SHAPES, revision="1"), "column 'revision': expected a whole number"),
    "a truth for a number": (row_change(SHAPES, revision=True), "expected a whole number"),
    "a number too large": (row_change(SHAPES, revision=2**63), "of 64 bits"),
    "a number for a truth": (row_change(SHAPES, allow_untextured=1), "expected true or false"),
    "a list for text": (row_change(SHAPES, name=[]), "column 'name': expected text"),
    "half a surrogate": (row_change(SHAPES, name="\ud800"), "column 'name'"),
    "no value where one must be": (row_change(SHAPES, name=None), "a value was expected"),
    "no moment": (row_change(SHAPES, created_at="yesterday"), "column 'created_at'"),
    "a moment without a zone": (row_change(SHAPES, created_at="2026-01-01"), "needs its time zone"),
    "a moment before time": (
        row_change(SHAPES, created_at="0001-01-01T00:00:00+14:00"),
        "column 'created_at'",
    ),
    "no base64": (row_change(BLOCKS, data="é"), "column 'data'"),
    "metadata that is a list": (row_change(SHAPES, metadata=[1]), "must be JSON objects"),
    "an unknown state": (row_change(SHAPES, status="bored"), "unknown state 'bored'"),
    "an id that leads outside": (row_change("tables/tombstones.jsonl", shape_id=7), "expected text"),
    "a shape twice": (first_row_again(SHAPES), "contradict others"),
    "a block of nobody": (row_change(BLOCKS, shape_id="nobody"), "contradict others"),
    "words of no vocabulary": (row_change(WORDS, vocabulary_id="v-0"), "contradict others"),
    "no JSON": (appended(SHAPES, b"{"), "is no row of it"),
    "JSON that is no object": (appended(SHAPES, b"[]"), "not a JSON object"),
    "JSON too deep": (appended(SHAPES, b'{"a":' + b"[" * 100_000), "nested too deeply"),
    "a number with too many digits": (appended(SHAPES, b'{"a":' + b"9" * 5000 + b"}"), "is no row of it"),
    "not a number": (appended(SHAPES, b'{"a":NaN}'), "NaN is not a number"),
    "no UTF-8": (appended(SHAPES, b'{"a":"\xff"}'), "is no row of it"),
    "an empty line": (appended(SHAPES, b""), "is no row of it"),
    "two states": (row_change(STATE, id=2), "must have one row"),
    "no state": (lambda parts: {**parts, STATE: b""}, "it has 0 rows"),
    "a revision from before": (row_change(STATE, revision=1), "older than some"),
    "a block that is none": (row_change(BLOCKS, data="AAAA"), "is damaged"),
    "a block of another length": (
        row_change(BLOCKS, data="AAEAAAAAAAAA"),
        "length is not that of the others",
    ),
    "a vocabulary that is none": (row_change("tables/vocabularies.jsonl", data="AAAA"), "cannot be read"),
    "a header that is no JSON": (
        lambda parts: {**parts, "library.json": b"no"},
        "library.json cannot be read",
    ),
    "a header without a schema": (header(schema=None), "the schema (text)"),
    "a header with more": (header(spy=1), "does not have the fields"),
    "a format from before": (header(format=0), "does not have the fields"),
    "a header of a gigabyte": (lambda parts: {**parts, "library.json": b" " * 2_000_000}, "does not begin"),
}
