"""Rows of an earlier schema become rows of this one, in a database that is nobody's."""

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from sqlalchemy import text

from index import staging
from index.dumping import one_moment
from index.errors import DamagedExport, NewerFormat, StorageFull
from index.portable import line_of
from index.staging import Staging
from tests.catalogues import add_queued, add_ready, open_catalogue
from tests.made_migrations import pretend_newer

Tables = dict[str, list[bytes]]


def written(folder: Path) -> tuple[str, Tables]:
    """Return the schema and the lines of a small catalogue."""
    opened = open_catalogue(folder)
    add_ready(opened, "one")
    add_queued(opened, "two")
    with one_moment(opened.engine) as moment:
        tables = {name: [line_of(row) for row in rows] for name, rows in moment.tables()}
        revision = moment.revision
    opened.engine.dispose()
    return revision, tables


def staged(folder: Path, revision: str, tables: Tables, then: Callable[[Staging], None]) -> None:
    folder.mkdir()
    with Staging(folder, revision) as stage:
        for name, lines in tables.items():
            stage.load(name, lines)
        stage.finish()
        then(stage)


def test_rows_come_back_the_same(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    revision, tables = written(tmp_path)

    def compare(stage: Staging) -> None:
        with one_moment(stage.engine) as moment:
            assert {name: [line_of(row) for row in rows] for name, rows in moment.tables()} == tables

    staged(tmp_path / "whole", revision, tables, compare)
    monkeypatch.setattr(staging, "_BYTES", 1)  # each row alone
    staged(tmp_path / "each", revision, tables, compare)


def test_the_steps_of_later_versions_are_taken(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    revision, tables = written(tmp_path)
    pretend_newer(monkeypatch, tmp_path)

    def compare(stage: Staging) -> None:
        with stage.engine.connect() as connection:
            found = connection.execute(text("SELECT id, initial FROM shapes ORDER BY id")).all()
            assert [tuple(row) for row in found] == [("one", "s"), ("two", "s")]
            assert connection.execute(text("SELECT count(*) FROM plain_blocks")).scalar_one() == 1

    staged(tmp_path / "stage", revision, tables, compare)


def test_an_unknown_schema_is_a_newer_one(tmp_path: Path) -> None:
    with pytest.raises(NewerFormat, match="'9999'"):
        Staging(tmp_path, "9999")
    assert list(tmp_path.iterdir()) == []


def test_tables_must_be_all_and_no_others(tmp_path: Path) -> None:
    revision, tables = written(tmp_path)
    less = {name: lines for name, lines in tables.items() if name != "jobs"}
    with pytest.raises(DamagedExport, match="lacks the tables jobs"):
        staged(tmp_path / "less", revision, less, lambda _: None)
    with pytest.raises(DamagedExport, match="'more' that its schema"):
        staged(tmp_path / "more", revision, {**tables, "more": []}, lambda _: None)


def test_the_line_is_named(tmp_path: Path) -> None:
    revision, tables = written(tmp_path)
    tables["shapes"][1] = b"{}\n"
    with pytest.raises(DamagedExport, match="line 2 of the table shapes"):
        staged(tmp_path / "stage", revision, tables, lambda _: None)


def test_rows_that_contradict_each_other_are_refused(tmp_path: Path) -> None:
    revision, tables = written(tmp_path)
    tables["files"] = [line.replace(b'"two"', b'"nobody"') for line in tables["files"]]
    with pytest.raises(DamagedExport, match="rows of the table files contradict"):
        staged(tmp_path / "stage", revision, tables, lambda _: None)


def test_a_full_disk_is_named(tmp_path: Path) -> None:
    revision, tables = written(tmp_path)
    (row,) = map(json.loads, tables["vocabularies"])
    long = json.dumps({**row, "data": "AAAA" * 300_000}).encode()
    (tmp_path / "stage").mkdir()

    def load() -> None:
        with Staging(tmp_path / "stage", revision) as stage:
            stage._connection.execute(text("PRAGMA max_page_count = 1"))  # taken for the present size
            stage.load("vocabularies", [long])

    with pytest.raises(StorageFull):
        load()
