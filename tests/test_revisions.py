from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from sqlalchemy import event

from tests.catalogues import Opened, add_queued, add_ready, open_catalogue
from tests.databases import only_on_sqlite

pytestmark = pytest.mark.usefixtures("database")  # on SQLite and on PostgreSQL


@pytest.fixture
def opened(tmp_path: Path) -> Iterator[Opened]:
    opened = open_catalogue(tmp_path)
    yield opened
    opened.engine.dispose()


def test_every_change_raises_the_revision_and_is_told_once(opened: Opened) -> None:
    catalogue = opened.catalogue

    def claim_and_give_back() -> None:
        job = opened.queue.claim("w", 60)
        assert job is not None
        opened.queue.give_back(job)

    changes: list[Callable[[], object]] = [
        lambda: add_queued(opened, "a"),
        claim_and_give_back,
        lambda: catalogue.update("a", name="n"),
        lambda: catalogue.update("a", metadata={"k": 1}),
    ]
    for change in changes:
        before = catalogue.revision()
        change()
        told = catalogue.changes_since(before)
        assert told.revision == catalogue.revision() > before
        assert (told.changed, told.removed) == (("a",), ())
        assert catalogue.changes_since(told.revision).changed == ()


def test_changes_come_in_their_order_with_removals_apart(opened: Opened) -> None:
    for shape_id in "abc":
        add_ready(opened, shape_id)
    before = opened.catalogue.revision()
    opened.catalogue.update("c", name="n")
    opened.catalogue.update("a", name="n")
    opened.catalogue.remove("b")
    changes = opened.catalogue.changes_since(before)
    assert (changes.changed, changes.removed) == (("c", "a"), ("b",))


@only_on_sqlite
def test_the_state_costs_one_statement(opened: Opened) -> None:
    statements: list[str] = []
    event.listen(opened.engine, "checkout", lambda taken, *_: taken.set_trace_callback(statements.append))
    opened.catalogue.state()
    assert [statement.split()[0] for statement in statements] == ["BEGIN", "SELECT", "ROLLBACK"]


def test_two_libraries_have_different_names(opened: Opened, tmp_path: Path) -> None:
    (tmp_path / "other").mkdir()
    other = open_catalogue(tmp_path / "other")
    assert other.catalogue.state().library != opened.catalogue.state().library
    other.engine.dispose()


def test_whoever_watches_while_others_write_misses_nothing(tmp_path: Path) -> None:
    writers = [open_catalogue(tmp_path) for _ in range(2)]
    watcher = open_catalogue(tmp_path)
    seen: set[str] = set()
    revision = 0

    def write(number: int) -> None:
        for step in range(25):
            add_queued(writers[number], f"w{number}-{step}")

    with ThreadPoolExecutor(2) as threads:
        running = [threads.submit(write, number) for number in range(2)]
        while not all(future.done() for future in running):
            changes = watcher.catalogue.changes_since(revision)
            seen.update(changes.changed)
            revision = changes.revision
        for future in running:
            future.result()
    seen.update(watcher.catalogue.changes_since(revision).changed)
    assert seen == {f"w{number}-{step}" for number in range(2) for step in range(25)}
    for opened in (*writers, watcher):
        opened.engine.dispose()
