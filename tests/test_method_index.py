from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from index.local_files import LocalFiles
from index.method_index import MethodIndex
from index.methods import METHODS
from index.pgvector.opening import views
from index.searcher import View
from tests.catalogues import Opened, add_ready, make_vocabulary, open_catalogue
from tests.databases import DATABASES, only_in_memory

pytestmark = pytest.mark.usefixtures("indexed")  # in memory, on SQLite and on PostgreSQL, and in pgvector

QUERY = {"hks-0": np.array([0.0, 0.0], dtype=np.float32)}
NEW = make_vocabulary(2)


@pytest.fixture
def opened(tmp_path: Path) -> Iterator[Opened]:
    opened = open_catalogue(tmp_path)
    opened.catalogue.add_vocabulary(NEW)
    yield opened
    opened.engine.dispose()


def make_index(opened: Opened, folder: Path) -> View:
    if DATABASES.index == "pgvector":
        return views(opened.catalogue, opened.engine)(METHODS["hks"])
    return MethodIndex(METHODS["hks"], opened.catalogue, LocalFiles(folder / "index"))


def answer(found: View) -> list[tuple[str, float]]:
    return found.rank(METHODS["hks"], QUERY, 10, (), None)


def test_before_it_has_caught_up_an_index_finds_nothing(opened: Opened, tmp_path: Path) -> None:
    add_ready(opened, "a")
    found = make_index(opened, tmp_path)
    assert answer(found) == []
    found.catch_up()
    assert answer(found) == [("a", 1.0)]


@pytest.mark.parametrize("known", [False, True], ids=["while it is built", "while it catches up"])
def test_a_vocabulary_that_changes_meanwhile_leaves_no_half_index(
    opened: Opened, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, known: bool
) -> None:
    for shape_id in "abc":
        add_ready(opened, shape_id)
    found = make_index(opened, tmp_path)
    if known:
        found.catch_up()
        opened.catalogue.update("b", name="new")
    for shape_id in "abc":
        opened.catalogue.add_quantised(shape_id, NEW.id, {"hks-0": [2.0, 1.0]})
    block_rows, shown = opened.catalogue.block_rows, []

    def overtaken(*told: object) -> Iterator[object]:
        if opened.catalogue.state().vocabulary_id != NEW.id:
            assert opened.catalogue.activate(NEW.id)  # between reading the state and reading the rows
        shown.append(answer(found))
        yield from block_rows(*told)  # type: ignore[arg-type] # handed on as it came

    monkeypatch.setattr(opened.catalogue, "block_rows", overtaken)
    found.catch_up()
    before = [("a", 1.0), ("b", 1.0), ("c", 1.0)] if known else []
    assert shown == [before, before]  # whole, until the new one takes its place
    assert answer(found) == [("a", 3.0), ("b", 3.0), ("c", 3.0)]


@only_in_memory
def test_an_unchanged_index_is_written_once(
    opened: Opened, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    add_ready(opened, "a")
    found = make_index(opened, tmp_path)
    found.catch_up()
    written: list[str] = []
    write = LocalFiles.write

    def watched(self: LocalFiles, key: str, fill: object) -> int:
        written.append(key)
        return write(self, key, fill)  # type: ignore[arg-type] # handed on as it came

    monkeypatch.setattr(LocalFiles, "write", watched)
    found.save()
    assert written == []
    again = make_index(opened, tmp_path)
    again.catch_up()
    again.save()
    assert written == []
    add_ready(opened, "b")
    again.catch_up()
    again.save()
    assert written == ["hks.vectors"]


@only_in_memory
def test_what_changed_before_the_file_was_written_is_read_again(opened: Opened, tmp_path: Path) -> None:
    for shape_id in "ab":
        add_ready(opened, shape_id)
    found = make_index(opened, tmp_path)
    found.catch_up()
    (tmp_path / "index" / "hks.vectors").unlink()
    add_ready(opened, "c")
    found.catch_up()
    opened.catalogue.add_quantised("a", opened.vocabulary_id, {"hks-0": [5.0, 0.0]})
    opened.catalogue.remove("b")
    found.save()  # shows neither of the two
    again = make_index(opened, tmp_path)
    again.catch_up()
    assert answer(again) == [("c", 1.0), ("a", 5.0)]
