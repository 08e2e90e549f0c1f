"""Libraries of every earlier version are brought to this one's schema, on both databases."""

import multiprocessing
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import pytest
from alembic.util import CommandError
from sqlalchemy import Engine

from index.catalogue import Catalogue
from index.database import make_engine
from index.jobs import MAX_ATTEMPTS
from index.migrating import migrate
from index.queue import Queue
from index.schema import revision_of
from index.searcher import Searcher
from index.shapes import Status
from index.tables import Base
from service.commands.explaining import explain
from tests.brute_force import agrees
from tests.catalogues import Opened
from tests.databases import DATABASES
from tests.earlier_schemas import REVISIONS, library_at, rows_of, schema_of
from tests.made_migrations import migrate_with, migrated_library, pretend_newer
from tests.serving import wait_until

pytestmark = pytest.mark.usefixtures("database")  # on SQLite and on PostgreSQL

ONE_MORE = """
    op.add_column("shapes", sa.Column("initial", sa.String(), nullable=False, server_default="?"))
"""

# Changes rows and a table, tells that it is in the middle, and never ends by itself.
ENDLESS = """
    import pathlib, time
    op.execute("DELETE FROM jobs")
    op.add_column("shapes", sa.Column("initial", sa.String(), nullable=False, server_default="?"))
    pathlib.Path({told!r}).touch()
    time.sleep(3600)
"""


def database_in(folder: Path) -> Engine:
    folder.mkdir(exist_ok=True)
    return make_engine(DATABASES.url(folder))


@pytest.mark.parametrize("revision", REVISIONS)
def test_a_library_of_any_version_keeps_every_row_and_comes_to_the_schema_of_a_new_one(
    tmp_path: Path, revision: str
) -> None:
    engine, before = library_at(tmp_path, revision)
    fresh = database_in(tmp_path / "fresh")
    migrate(fresh)
    migrate(engine)
    assert schema_of(engine) == schema_of(fresh)
    after = rows_of(engine)
    assert after.keys() == set(Base.metadata.tables)
    for table, rows in before.items():
        kept = [{name: row[name] for name in rows[0]} for row in after[table]] if rows else after[table]
        assert sorted(kept, key=repr) == rows, table
    assert {row["folded"] for row in after["tags"]} == {"vase", "old"}
    assert {row["fingerprint"] for row in after["plain_blocks"]} == {"0123456789abcdef"}
    fresh.dispose()
    engine.dispose()


@pytest.mark.parametrize("revision", REVISIONS)
def test_a_library_of_any_version_goes_on(tmp_path: Path, revision: str) -> None:
    engine, _ = library_at(tmp_path, revision)
    migrate(engine)
    catalogue = Catalogue(engine)
    vocabulary_id = catalogue.state().vocabulary_id
    assert vocabulary_id is not None
    opened = Opened(engine=engine, catalogue=catalogue, queue=Queue(engine), vocabulary_id=vocabulary_id)
    assert agrees(Searcher(catalogue, tmp_path / "index"), opened)
    assert catalogue.counts()[Status.READY] == 5
    job = opened.queue.claim("another", 60)
    assert job is not None
    assert (job.shape_id, job.attempts) == ("waiting", 1)
    assert job.attempts < MAX_ATTEMPTS
    catalogue.remove("s0000")  # with all that belongs to it
    left = rows_of(engine)
    for table in ("plain_blocks", "quantised_blocks"):
        assert {row["shape_id"] for row in left[table]} == {"s0001", "s0002", "s0003", "s0004"}
    engine.dispose()


def test_processes_may_migrate_at_once(tmp_path: Path) -> None:
    url = DATABASES.url(tmp_path)
    with ProcessPoolExecutor(3, mp_context=multiprocessing.get_context("spawn")) as processes:
        libraries = set(processes.map(migrated_library, [url] * 3))
    assert len(libraries) == 1


def test_a_migration_that_is_killed_leaves_the_earlier_schema_whole(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    engine, before = library_at(tmp_path, "head")
    schema, told = schema_of(engine), tmp_path / "told"
    with monkeypatch.context() as patch:
        pretend_newer(patch, tmp_path, ENDLESS.format(told=str(told)))
        url = engine.url.render_as_string(hide_password=False)
        arguments = (tmp_path / "migrations", url)
        killed = multiprocessing.get_context("spawn").Process(target=migrate_with, args=arguments)
        killed.start()
        wait_until(lambda: told.exists() or not killed.is_alive())
        assert killed.is_alive()
        killed.kill()
        killed.join()
    assert schema_of(engine) == schema
    assert rows_of(engine) == before
    migrate(engine)  # nothing is left locked
    with engine.connect() as connection:
        assert revision_of(connection) == REVISIONS[-1]
    engine.dispose()


def test_a_library_of_a_newer_schema_is_refused_in_words_and_left_as_it_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    engine, _ = library_at(tmp_path, "head")
    with monkeypatch.context() as patch:
        pretend_newer(patch, tmp_path, ONE_MORE)
        migrate(engine)
    before = rows_of(engine)
    with pytest.raises(CommandError) as refused:
        migrate(engine)
    assert "made by a newer version of Faience; update Faience" in str(explain(refused.value))
    assert rows_of(engine) == before
    engine.dispose()
