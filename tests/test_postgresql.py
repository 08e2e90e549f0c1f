"""What is PostgreSQL's own: its text, its locks, its sequences, a server that restarts."""

from collections.abc import Iterator
from pathlib import Path

import psycopg
import pytest
from sqlalchemy import func, make_url, select
from sqlalchemy.exc import OperationalError

from index.catalogue import Catalogue
from index.database import make_engine, reading, writing
from index.errors import CatalogueBusy, ShapeNotFound
from index.migrating import migrate
from index.postgresql import sendable
from index.replacing import replace_library
from index.revisions import lock_state
from index.shapes import Status
from index.tables import JobRow
from tests.catalogues import Opened, add_queued, open_catalogue
from tests.databases import DATABASES, postgresql


@pytest.fixture
def opened(database_server: str, tmp_path: Path) -> Iterator[Opened]:
    DATABASES.kind, DATABASES.server = "postgresql", database_server
    try:
        found = open_catalogue(tmp_path)
    finally:
        DATABASES.kind = "sqlite"
    yield found
    found.engine.dispose()


def test_text_that_it_cannot_hold_is_found_nowhere_and_breaks_nothing(opened: Opened) -> None:
    add_queued(opened, "a")
    for odd in ("a\0", "\0", "\ud800", "a\udfff"):
        with pytest.raises(ShapeNotFound):
            opened.catalogue.get(odd)
        with pytest.raises(ShapeNotFound):
            opened.catalogue.query_blocks(odd, ["hks-0"])
        assert opened.catalogue.get_many([odd, "a"]).keys() == {"a"}
        assert opened.catalogue.find_content(odd) is None
    assert sendable("plain, even ü and 𝄞") == "plain, even ü and 𝄞"


def test_a_writer_waits_only_so_long_for_another(opened: Opened) -> None:
    impatient = make_engine(opened.engine.url.render_as_string(hide_password=False), busy_seconds=0.05)
    with writing(opened.engine) as session:
        lock_state(session)
        with pytest.raises(CatalogueBusy), writing(impatient) as other:
            lock_state(other)
        with reading(impatient) as other:  # who reads waits for nobody
            assert other.scalars(select(func.count()).select_from(JobRow)).one() == 0
    with writing(impatient) as other:
        lock_state(other)
    impatient.dispose()


def test_a_reader_sees_one_moment(opened: Opened) -> None:
    with reading(opened.engine) as session:
        before = session.scalars(select(func.count()).select_from(JobRow)).one()
        add_queued(opened, "a")
        assert session.scalars(select(func.count()).select_from(JobRow)).one() == before


def test_a_reader_cannot_write(opened: Opened) -> None:
    add_queued(opened, "a")
    with pytest.raises(Exception, match="read-only"), reading(opened.engine) as session:
        session.add(JobRow(shape_id="a", attempts=0))


def test_the_address_needs_no_name_of_a_driver(opened: Opened) -> None:
    assert opened.engine.driver == "psycopg"


def test_jobs_after_an_import_get_ids_that_no_job_has(opened: Opened, tmp_path: Path) -> None:
    (tmp_path / "staged").mkdir()
    staged = open_catalogue(tmp_path / "staged")
    for number in range(5):
        add_queued(staged, f"s{number}")
    replace_library(opened.engine, staged.engine)
    add_queued(opened, "later")
    with reading(opened.engine) as session:
        ids = session.scalars(select(JobRow.id).order_by(JobRow.id)).all()
    assert ids == [1, 2, 3, 4, 5, 6]
    staged.engine.dispose()


def test_a_database_without_an_encoding_holds_any_text(database_server: str) -> None:
    name = "without_encoding"
    with psycopg.connect(database_server, autocommit=True) as connection:
        connection.execute(
            f"CREATE DATABASE {name} TEMPLATE template0 ENCODING 'SQL_ASCII' LC_COLLATE 'C' LC_CTYPE 'C'"
        )
    engine = make_engine(make_url(database_server).set(database=name).render_as_string(hide_password=False))
    migrate(engine)
    catalogue = Catalogue(engine)
    catalogue.accept(id="a", name="Krüge und 壺", metadata={"für": "甕"}, sha256="ab", files=[])
    found = catalogue.get("a")
    assert (found.name, found.metadata) == ("Krüge und 壺", {"für": "甕"})
    engine.dispose()


def test_a_server_that_restarts_costs_no_request_after_it(tmp_path: Path) -> None:
    with postgresql(tmp_path / "data") as address:
        engine = make_engine(address)
        migrate(engine)
        catalogue = Catalogue(engine)
        assert catalogue.counts()[Status.READY] == 0
        with psycopg.connect(address, autocommit=True) as other:  # what a restart does to connections
            other.execute(
                "SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE pid <> pg_backend_pid()"
                " AND backend_type = 'client backend'"
            )
        assert catalogue.counts()[Status.READY] == 0
        assert catalogue.revision() == 0
    with pytest.raises(OperationalError):  # it is gone: told as unreachable, not as a defect
        catalogue.revision()
    engine.dispose()
