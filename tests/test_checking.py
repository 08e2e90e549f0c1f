"""Nothing of an archive is believed: what no export could have written is refused, with nothing imported."""

import io
import json
import os
import tarfile
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from index.errors import ExportRefused, NewerFormat
from service.backup import checking
from service.backup.importing import import_library
from service.library import Library
from tests.backups import (
    Parts,
    edited,
    exported,
    files_of,
    forged,
    opened,
    parts_of,
    rows_of,
    with_sums,
    write_parts,
)

Change = Callable[[Parts], Parts | None]
STATE, SHAPES, FILES = "tables/state.jsonl", "tables/shapes.jsonl", "tables/files.jsonl"
BLOCKS, WORDS = "tables/plain_blocks.jsonl", "tables/quantised_blocks.jsonl"


@pytest.fixture(scope="module")
def archive(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return an honest archive."""
    return exported(tmp_path_factory.mktemp("archive"))


@pytest.fixture(scope="module")
def empty(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Library]:
    """Yield a library in which every refusal leaves nothing."""
    with opened(tmp_path_factory.mktemp("empty")) as library:
        yield library


def refused(library: Library, archive: Path, code: str = "damaged_export") -> str:
    """Import what must be refused; return why it was."""
    rows = rows_of(library)
    with pytest.raises(ExportRefused) as caught:
        import_library(library, archive)
    assert rows_of(library) == rows
    assert files_of(library) == {}
    assert os.listdir(library.incoming.folder) == [".lock"]  # noqa: PTH208 - names are enough
    assert caught.value.code == code
    return str(caught.value)


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


@pytest.mark.parametrize("case", HOSTILE)
def test_what_no_export_could_hold_is_refused(
    empty: Library, tmp_path: Path, archive: Path, case: str
) -> None:
    change, reason = HOSTILE[case]
    parts = parts_of(archive)
    path = write_parts(tmp_path / "forged.tar", with_sums(change(parts) or parts))
    assert reason in refused(empty, path)


def test_a_newer_format_and_a_newer_schema_are_told(empty: Library, tmp_path: Path, archive: Path) -> None:
    newer = [(header(format=2, more=1), "reads up to 1"), (header(schema="9999"), "the schema '9999'")]
    for change, reason in newer:
        parts = parts_of(archive)
        change(parts)
        path = write_parts(tmp_path / "forged.tar", with_sums(parts))
        assert reason in refused(empty, path, NewerFormat.code)


def test_an_id_that_leads_outside_is_refused(empty: Library, tmp_path: Path, archive: Path) -> None:
    def change(parts: Parts) -> None:
        id_of = json.loads(parts[SHAPES].splitlines()[0])["id"]
        for name in (SHAPES, FILES, BLOCKS, WORDS, "tables/jobs.jsonl"):
            parts[name] = parts[name].replace(f'"{id_of}"'.encode(), b'"../../outside"')

    parts = parts_of(archive)
    change(parts)
    path = write_parts(tmp_path / "forged.tar", with_sums(parts))
    assert "no id of a shape" in refused(empty, path)


def test_an_altered_member_is_named(empty: Library, tmp_path: Path, archive: Path) -> None:
    parts = parts_of(archive)
    name = first_file(parts)
    parts[name] = bytes([parts[name][0] ^ 1]) + parts[name][1:]
    path = write_parts(tmp_path / "altered.tar", parts)
    assert f"the checksum of {name!r} is wrong" in refused(empty, path)


def test_a_member_that_vanished_or_came_is_named(empty: Library, tmp_path: Path, archive: Path) -> None:
    parts = parts_of(archive)
    name = first_file(parts)
    less = {each: data for each, data in parts.items() if each != name}
    assert "checksum" in refused(empty, write_parts(tmp_path / "less.tar", less))
    last = {**parts, "SHA256SUMS": b"".join(parts["SHA256SUMS"].splitlines(keepends=True)[:-1])}
    path = write_parts(tmp_path / "last.tar", last)
    assert "the checksum of 'tables/" in refused(empty, path)
    more = {**parts, "SHA256SUMS": parts["SHA256SUMS"] + b"0" * 64 + b"  files/ghost\n"}
    path = write_parts(tmp_path / "more.tar", more)
    assert "files/ghost" in refused(empty, path)


def test_a_file_that_was_cut_is_refused_wherever_it_was_cut(
    empty: Library, tmp_path: Path, archive: Path
) -> None:
    whole = archive.read_bytes()
    end = len(whole) - 1024 - 512  # the last content, then zeros
    for share in (0, 1, 511, 512, 700, len(whole) // 3, len(whole) // 2, end - 4096, end):
        path = tmp_path / "cut.tar"
        path.write_bytes(whole[:share])
        refused(empty, path)


def test_what_follows_the_end_is_refused(empty: Library, tmp_path: Path, archive: Path) -> None:
    parts = parts_of(archive)
    late = write_parts(tmp_path / "late.tar", {**parts, "tables/late.jsonl": b""})
    assert "wrong place" in refused(empty, late)
    twice = archive.read_bytes() * 2
    (tmp_path / "twice.tar").write_bytes(twice)
    assert "follows the end" in refused(empty, tmp_path / "twice.tar")


def member(name: str, kind: bytes = tarfile.REGTYPE, size: int = 0, link: str = "") -> bytes:
    info = tarfile.TarInfo(name)
    info.type, info.size, info.linkname = kind, size, link
    return info.tobuf(tarfile.GNU_FORMAT)


def beginning(whole: bytes) -> bytes:
    """Return the first member of an archive."""
    return whole[: whole.index(b"files/")]


KINDS = {
    "symbolic link": tarfile.SYMTYPE,
    "link": tarfile.LNKTYPE,
    "device": tarfile.CHRTYPE,
    "block device": tarfile.BLKTYPE,
    "pipe": tarfile.FIFOTYPE,
    "folder": tarfile.DIRTYPE,
    "long name": tarfile.GNUTYPE_LONGNAME,
    "sparse file": tarfile.GNUTYPE_SPARSE,
    "extended header": tarfile.XHDTYPE,
    "global header": tarfile.XGLTYPE,
    "unknown kind": b"Z",
}


@pytest.mark.parametrize("kind", KINDS)
def test_only_plain_files_are_taken(empty: Library, tmp_path: Path, archive: Path, kind: str) -> None:
    whole = archive.read_bytes()
    head = beginning(whole)
    odd = member("files/shapes/a/b", KINDS[kind], link="/etc/passwd")
    for data in (odd + whole, head + odd + whole[len(head) :]):
        (tmp_path / "odd.tar").write_bytes(data)
        assert "is not a plain file" in refused(empty, tmp_path / "odd.tar")


def test_the_same_member_twice_is_refused(empty: Library, tmp_path: Path, archive: Path) -> None:
    parts = parts_of(archive)
    name = first_file(parts)
    with tarfile.open(tmp_path / "twice.tar", "w") as out:
        for each in ("library.json", name, name):
            info = tarfile.TarInfo(each)
            info.size = len(parts[each])
            out.addfile(info, io.BytesIO(parts[each]))
    assert f"{name!r} twice" in refused(empty, tmp_path / "twice.tar")


def test_a_size_that_lies_is_refused(empty: Library, tmp_path: Path, archive: Path) -> None:
    whole = archive.read_bytes()
    for size in (10, 10**9, 2**60):
        head = beginning(whole)
        data = head + member("files/shapes/a/b", size=size) + whole[len(head) :]
        (tmp_path / "lie.tar").write_bytes(data)
        refused(empty, tmp_path / "lie.tar")


def test_a_line_without_end_is_refused_before_it_is_read(
    empty: Library, archive: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(checking, "LONGEST_LINE", 1 << 16)
    path = forged(archive, appended(STATE, b" " * (1 << 17)))
    assert "more than 65536 bytes" in refused(empty, path)


SHARES = st.floats(0, 1, exclude_max=True)  # of the file before the changed byte


@settings(max_examples=50, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    places=st.lists(st.tuples(st.floats(0, 1, exclude_max=True), st.integers(1, 255)), min_size=1, max_size=3)
)
def test_changed_bytes_are_refused_or_change_nothing(
    tmp_path_factory: pytest.TempPathFactory, archive: Path, places: list[tuple[float, int]]
) -> None:
    folder = tmp_path_factory.mktemp("changed")
    data = bytearray(archive.read_bytes())
    for share, change in places:
        data[int(share * len(data))] ^= change
    (folder / "changed.tar").write_bytes(data)
    with opened(folder / "to") as library:
        rows = rows_of(library)
        try:
            import_library(library, folder / "changed.tar")
        except ExportRefused:
            assert (rows_of(library), files_of(library)) == (rows, {})
        else:
            with opened(archive.parent / "honest") as honest:
                if not sum(honest.catalogue.counts().values()):
                    import_library(honest, archive)
                assert (rows_of(library), files_of(library)) == (rows_of(honest), files_of(honest))
