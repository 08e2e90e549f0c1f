"""What a database tells of its own schema."""

from pathlib import Path

import pytest
from sqlalchemy import JSON, insert, select, text

from index.database import make_engine
from index.migrating import migrate
from index.portable import readers_of
from index.schema import LEFT_OUT, is_known, library_tables, revision_of
from index.tables import Base
from tests.made_migrations import pretend_newer


def test_every_table_but_the_keys_makes_a_library_and_can_be_carried_over(tmp_path: Path) -> None:
    engine = make_engine(f"sqlite:///{tmp_path / 'c.db'}")
    migrate(engine)
    with engine.connect() as connection:
        tables = library_tables(connection)
        assert {table.name for table in tables} == set(Base.metadata.tables) - LEFT_OUT
        for table in tables:
            assert readers_of(table).keys() == {column.name for column in Base.metadata.tables[table.name].c}
    engine.dispose()


def test_a_table_follows_those_that_it_refers_to(tmp_path: Path) -> None:
    engine = make_engine(f"sqlite:///{tmp_path / 'c.db'}")
    migrate(engine)
    with engine.connect() as connection:
        tables = library_tables(connection)
    names = [table.name for table in tables]
    for table in tables:
        for key in table.foreign_keys:
            assert names.index(key.column.table.name) < names.index(table.name)
    engine.dispose()


def test_nothing_is_null_and_not_the_word(tmp_path: Path) -> None:
    engine = make_engine(f"sqlite:///{tmp_path / 'c.db'}")
    with engine.begin() as connection:
        connection.execute(text("CREATE TABLE trees (id INTEGER PRIMARY KEY, tree JSON)"))
        (table,) = library_tables(connection)
        assert isinstance(table.c.tree.type, JSON)
        connection.execute(insert(table), [{"id": 1, "tree": None}, {"id": 2, "tree": {"a": 1}}])
        assert connection.scalars(text("SELECT tree FROM trees ORDER BY id")).all() == [None, '{"a": 1}']
        assert connection.scalars(select(table.c.tree).order_by(table.c.id)).all() == [None, {"a": 1}]
    engine.dispose()


def test_revisions_are_known_by_their_whole_names(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    engine = make_engine(f"sqlite:///{tmp_path / 'c.db'}")
    with engine.connect() as connection, pytest.raises(ValueError, match="never migrated"):
        revision_of(connection)
    migrate(engine, "0001")
    with engine.connect() as connection:
        assert revision_of(connection) == "0001"
    assert is_known("0001")
    for name in ("made", "000", "0001+1", "head", "base", "", "../0001"):
        assert not is_known(name)
    pretend_newer(monkeypatch, tmp_path)
    assert is_known("made")
    engine.dispose()
