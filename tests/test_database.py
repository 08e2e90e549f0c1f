import sqlite3
from pathlib import Path
from typing import Any

import pytest
from alembic.autogenerate import compare_metadata
from alembic.migration import MigrationContext
from sqlalchemy import event, inspect, select, text

from index.database import make_engine, reading, writing
from index.errors import CatalogueBusy, StorageFull, UnknownDatabase
from index.migrating import migrate
from index.revisions import now
from index.tables import Base, StateRow, VocabularyRow
from tests.catalogues import add_ready, open_catalogue
from tests.made_migrations import pretend_newer


def url_in(folder: Path) -> str:
    return f"sqlite:///{folder / 'catalogue.db'}"


def migrate_in(folder: Path) -> str:
    engine = make_engine(url_in(folder))
    migrate(engine)
    with reading(engine) as session:
        library = session.scalars(select(StateRow.library)).one()
    engine.dispose()
    return library


def test_the_migrations_lead_to_the_mapped_tables(tmp_path: Path) -> None:
    engine = make_engine(url_in(tmp_path))
    migrate(engine)
    with engine.connect() as connection:
        context = MigrationContext.configure(
            connection, opts={"compare_type": True, "compare_server_default": True}
        )
        assert compare_metadata(context, Base.metadata) == []
        for table in Base.metadata.sorted_tables:  # what the comparison leaves out
            constraint = inspect(connection).get_pk_constraint(table.name)
            assert constraint["constrained_columns"] == [column.name for column in table.primary_key]
            told = {
                (key["constrained_columns"][0], key["referred_table"], key["options"].get("ondelete"))
                for key in inspect(connection).get_foreign_keys(table.name)
            }
            assert told == {
                (key.parent.name, key.column.table.name, key.ondelete) for key in table.foreign_keys
            }
    engine.dispose()


def test_migrating_again_changes_nothing(tmp_path: Path) -> None:
    assert migrate_in(tmp_path) == migrate_in(tmp_path)


def test_commits_are_durable_and_keys_are_checked(tmp_path: Path) -> None:
    engine = make_engine(url_in(tmp_path))
    with engine.connect() as connection:
        told = [
            connection.execute(text(f"PRAGMA {name}")).scalar_one()
            for name in ("journal_mode", "synchronous", "foreign_keys", "busy_timeout")
        ]
    assert told == ["wal", 2, 1, 15_000]
    engine.dispose()


def test_a_failed_transaction_leaves_nothing(tmp_path: Path) -> None:
    engine = make_engine(url_in(tmp_path))
    migrate(engine)

    def write_and_fail() -> None:
        with writing(engine) as session:
            session.add(VocabularyRow(id="v", fingerprint="f", data=b"", created_at=now()))
            session.flush()
            raise RuntimeError("on the way")

    with pytest.raises(RuntimeError):
        write_and_fail()
    with reading(engine) as session:
        assert session.get(VocabularyRow, "v") is None
    engine.dispose()


def test_readers_go_on_and_writers_are_told_while_another_process_writes(tmp_path: Path) -> None:
    engine = make_engine(url_in(tmp_path), busy_seconds=0.05)
    migrate(engine)
    other = sqlite3.connect(tmp_path / "catalogue.db", isolation_level=None)
    other.execute("BEGIN IMMEDIATE")
    with reading(engine) as session:
        assert session.get(VocabularyRow, "v") is None
    with pytest.raises(CatalogueBusy), writing(engine) as session:
        session.execute(select(StateRow))
    other.execute("ROLLBACK")
    other.close()
    with writing(engine) as session:
        session.add(VocabularyRow(id="v", fingerprint="f", data=b"", created_at=now()))
    engine.dispose()


def test_a_full_disk_is_named_reads_go_on_and_writes_recover(tmp_path: Path) -> None:
    engine = make_engine(url_in(tmp_path))
    migrate(engine)
    pages = {"limit": 0}

    @event.listens_for(engine, "begin")
    def limit(connection: Any) -> None:
        connection.exec_driver_sql(f"PRAGMA max_page_count = {pages['limit'] or 1_000_000}")

    def add(size: int) -> None:
        with writing(engine) as session:
            session.add(VocabularyRow(id="v", fingerprint="f", data=bytes(size), created_at=now()))

    pages["limit"] = 1  # SQLite takes this for the present size
    with pytest.raises(StorageFull):
        add(1_000_000)
    with reading(engine) as session:
        assert session.get(VocabularyRow, "v") is None
    pages["limit"] = 0
    add(1_000_000)
    engine.dispose()


def test_a_step_that_makes_a_table_anew_keeps_what_depends_on_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    opened = open_catalogue(tmp_path)
    add_ready(opened, "one")
    opened.engine.dispose()
    pretend_newer(monkeypatch, tmp_path)
    opened = open_catalogue(tmp_path)
    with opened.engine.connect() as connection:
        assert connection.execute(text("SELECT initial FROM shapes")).scalars().all() == ["s"]
        assert connection.execute(text("PRAGMA foreign_keys")).scalar_one() == 1
    assert len(opened.catalogue.get("one").files) == 1
    assert set(opened.catalogue.blocks("one", opened.vocabulary_id)) == {"colour-histogram", "hks-0"}
    opened.engine.dispose()


def test_a_step_that_breaks_references_is_undone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    opened = open_catalogue(tmp_path)
    add_ready(opened, "one")
    pretend_newer(monkeypatch, tmp_path)
    step = next((tmp_path / "migrations" / "versions").glob("r9999*"))
    step.write_text(
        step.read_text().replace("UPDATE shapes SET initial = substr(name, 1, 1)", "DELETE FROM shapes")
    )
    with pytest.raises(RuntimeError, match="without what they refer to in shapes"):
        migrate(opened.engine)
    assert opened.catalogue.get("one").name == "shape one"
    opened.engine.dispose()


def test_other_kinds_of_databases_are_refused_by_name() -> None:
    with pytest.raises(UnknownDatabase, match="sqlite or postgresql, not in 'mysql'"):
        make_engine("mysql://somewhere/else")
