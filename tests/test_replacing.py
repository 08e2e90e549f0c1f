"""An empty library becomes another one at once, and whoever has it open notices."""

from pathlib import Path
from typing import Any

import pytest

from index.dumping import one_moment
from index.errors import LibraryNotEmpty
from index.replacing import check_empty, replace_library
from tests.catalogues import Opened, add_queued, add_ready, open_catalogue

pytestmark = pytest.mark.usefixtures("database")  # on SQLite and on PostgreSQL


def rows_of(opened: Opened) -> dict[str, list[dict[str, Any]]]:
    with one_moment(opened.engine) as moment:
        return {name: list(rows) for name, rows in moment.tables()}


def two_catalogues(folder: Path) -> tuple[Opened, Opened]:
    """Return one with shapes, and an empty one."""
    opened = []
    for name in ("full", "empty"):
        (folder / name).mkdir()
        opened.append(open_catalogue(folder / name))
    add_ready(opened[0], "one")
    add_queued(opened[0], "two")
    add_queued(opened[0], "gone")
    opened[0].catalogue.remove("gone")
    return opened[0], opened[1]


def test_everything_is_taken_over(tmp_path: Path) -> None:
    full, empty = two_catalogues(tmp_path)
    replace_library(empty.engine, full.engine)
    assert rows_of(empty) == rows_of(full)
    assert empty.catalogue.state() == full.catalogue.state()
    assert empty.catalogue.changes_since(0) == full.catalogue.changes_since(0)
    for opened in (full, empty):
        opened.engine.dispose()


def test_a_library_with_a_shape_is_not_touched(tmp_path: Path) -> None:
    full, empty = two_catalogues(tmp_path)
    add_queued(empty, "here")
    before = rows_of(empty)
    with pytest.raises(LibraryNotEmpty, match="has 1"):
        replace_library(empty.engine, full.engine)
    assert rows_of(empty) == before
    for opened in (full, empty):
        opened.engine.dispose()


def test_an_empty_library_passes() -> None:
    check_empty(0)


def test_revisions_never_go_back(tmp_path: Path) -> None:
    full, empty = two_catalogues(tmp_path)
    for number in range(10):
        add_queued(empty, str(number))
        empty.catalogue.remove(str(number))
    last = empty.catalogue.revision()
    assert last > full.catalogue.revision()
    replace_library(empty.engine, full.engine)
    assert empty.catalogue.revision() == last
    for opened in (full, empty):
        opened.engine.dispose()


def test_the_same_library_gets_a_new_epoch_another_keeps_its_own(tmp_path: Path) -> None:
    full, empty = two_catalogues(tmp_path)
    epoch = full.catalogue.state().epoch
    replace_library(empty.engine, full.engine)
    assert empty.catalogue.state().epoch == epoch
    for shape_id in ("one", "two"):
        empty.catalogue.remove(shape_id)
    replace_library(empty.engine, full.engine)
    assert empty.catalogue.state().epoch == epoch + 1
    assert empty.catalogue.state().library == full.catalogue.state().library
    for opened in (full, empty):
        opened.engine.dispose()
