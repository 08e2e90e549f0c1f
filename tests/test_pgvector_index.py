from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from sqlalchemy import text

from index.database import make_engine
from index.errors import CatalogueBusy
from index.methods import METHODS, with_weights
from index.pgvector.cursors import reading_cursor, wait_for_turn, writing_cursor
from index.pgvector.held import Held, read_held
from index.pgvector.index import PgvectorIndex
from index.pgvector.names import lock_number
from index.pgvector.opening import views
from tests.catalogues import Opened, add_ready, open_catalogue
from tests.databases import DATABASES

HKS = METHODS["hks"]
QUERY = {"hks-0": np.array([0.0, 0.0], dtype=np.float32)}


@pytest.fixture
def opened(database_server: str, tmp_path: Path) -> Iterator[Opened]:
    DATABASES.kind, DATABASES.server = "postgresql", database_server
    try:
        found = open_catalogue(tmp_path)
    finally:
        DATABASES.kind = "sqlite"
    yield found
    found.engine.dispose()


def make(opened: Opened, *, graph: bool = False) -> PgvectorIndex:
    return views(opened.catalogue, opened.engine, graph=graph)(HKS)


def answer(index: PgvectorIndex, limit: int = 10) -> list[tuple[str, float]]:
    return index.rank(HKS, QUERY, limit, (), None)


def held_of(opened: Opened) -> Held:
    with writing_cursor(opened.engine) as cursor:
        held = read_held(cursor, "hks")
    assert held is not None
    return held


def tables(opened: Opened) -> list[str]:
    with reading_cursor(opened.engine) as cursor:
        cursor.execute("SELECT tablename FROM pg_tables WHERE schemaname = 'faience_index'")
        return sorted(name for (name,) in cursor.fetchall())


def test_what_one_process_brought_up_to_date_no_other_reads_again(
    opened: Opened, monkeypatch: pytest.MonkeyPatch
) -> None:
    add_ready(opened, "a")
    make(opened).catch_up()
    monkeypatch.setattr(opened.catalogue, "block_rows", None)  # whoever reads rows fails
    other = make(opened)
    other.catch_up()
    assert answer(other) == [("a", 1.0)]


def test_a_library_without_shapes_has_no_table_and_gets_one_with_the_first(opened: Opened) -> None:
    index = make(opened)
    index.catch_up()
    assert held_of(opened).empty
    assert answer(index) == []
    add_ready(opened, "a")
    index.catch_up()
    assert answer(index) == [("a", 1.0)]


def test_rows_of_another_form_are_built_anew(opened: Opened, monkeypatch: pytest.MonkeyPatch) -> None:
    add_ready(opened, "a")
    make(opened).catch_up()
    before = held_of(opened)
    monkeypatch.setattr("index.pgvector.form.VERSION", 999)
    index = make(opened)
    index.catch_up()
    assert held_of(opened).number == before.number + 1
    assert answer(index) == [("a", 1.0)]
    assert tables(opened) == ["held", f"hks-{before.number + 1}"]  # the old one is gone


def test_a_replaced_table_that_is_still_read_costs_no_answer(
    opened: Opened, monkeypatch: pytest.MonkeyPatch
) -> None:
    add_ready(opened, "a")
    make(opened).catch_up()
    hasty = make_engine(opened.engine.url.render_as_string(hide_password=False), busy_seconds=0.05)
    monkeypatch.setattr("index.pgvector.form.VERSION", 999)
    index = PgvectorIndex(HKS, opened.catalogue, hasty)
    with reading_cursor(opened.engine) as cursor:
        cursor.execute('SELECT count(*) FROM faience_index."hks-1"')
        index.catch_up()
        assert answer(index) == [("a", 1.0)]
    assert tables(opened) == ["held", "hks-1", "hks-2"]
    hasty.dispose()
    monkeypatch.setattr("index.pgvector.form.VERSION", 1000)
    make(opened).catch_up()
    assert tables(opened) == ["held", "hks-3"]  # all that was left goes with the next


def test_a_table_that_is_replaced_in_this_moment_is_looked_for_again(
    opened: Opened, monkeypatch: pytest.MonkeyPatch
) -> None:
    add_ready(opened, "a")
    index = make(opened)
    index.catch_up()
    held = held_of(opened)
    gone = Held(**{**vars(held), "number": held.number + 1})
    told = iter([gone, held])
    monkeypatch.setattr("index.pgvector.index.read_held", lambda *_: next(told))
    assert answer(index) == [("a", 1.0)]
    monkeypatch.setattr("index.pgvector.index.read_held", lambda *_: gone)
    with pytest.raises(CatalogueBusy):
        answer(index)


def test_a_table_newer_than_a_restored_catalogue_is_not_believed(opened: Opened) -> None:
    for shape_id in "ab":
        add_ready(opened, shape_id)
    index = make(opened)
    index.catch_up()
    with opened.engine.begin() as connection:
        connection.execute(text("DELETE FROM shapes WHERE id = 'b'"))
        connection.execute(text("UPDATE state SET revision = revision - 2"))
    index.catch_up()
    assert answer(index) == [("a", 1.0)]


def test_whoever_waits_too_long_for_another_process_is_told(opened: Opened) -> None:
    add_ready(opened, "a")
    prepared = make(opened)
    hasty = make_engine(opened.engine.url.render_as_string(hide_password=False), busy_seconds=0.05)
    index = PgvectorIndex(HKS, opened.catalogue, hasty)
    with writing_cursor(opened.engine) as cursor:
        wait_for_turn(cursor, lock_number("hks"))
        with pytest.raises(CatalogueBusy):
            index.catch_up()
    hasty.dispose()
    prepared.catch_up()
    assert answer(prepared) == [("a", 1.0)]


def test_a_second_look_is_counted(opened: Opened) -> None:
    for number in range(20):
        add_ready(opened, f"s{number:02}")
    index = make(opened)
    index.catch_up()
    assert answer(index, 1) == [("s00", 1.0)]
    assert index.escalations == 1  # all are equal
    assert len(answer(index, 20)) == 20
    assert index.escalations == 1


def test_a_graph_is_added_to_a_table_that_has_none_and_followed_by_what_comes(opened: Opened) -> None:
    add_ready(opened, "a")
    make(opened).catch_up()
    index = make(opened, graph=True)
    index.catch_up()
    assert held_of(opened).has_graph
    add_ready(opened, "b")
    opened.catalogue.remove("a")
    index.catch_up()
    assert held_of(opened).number == 1
    assert answer(index) == [("b", 1.0)]


def test_only_a_graph_proves_nothing_and_only_where_it_is_asked(opened: Opened) -> None:
    exact, graph = make(opened), make(opened, graph=True)
    own = with_weights(HKS, {"hks-0": 2.0})
    assert exact.proves(HKS, 10)
    assert not graph.proves(HKS, 10)
    assert graph.proves(own, 10)  # a graph knows no other weights: all rows are read
    assert graph.proves(HKS, 1_000)  # nor so many rows
