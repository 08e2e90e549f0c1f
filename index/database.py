"""The database: engine, transactions, migrations. SQLite by default."""

import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from importlib.resources import as_file, files
from typing import Any

from alembic import command
from alembic.config import Config
from alembic.migration import MigrationContext
from sqlalchemy import Connection, Engine, create_engine, event
from sqlalchemy.engine.interfaces import DBAPICursor
from sqlalchemy.exc import OperationalError
from sqlalchemy.orm import Session

from index.errors import CatalogueBusy, StorageFull

SCRIPTS = files("index") / "migrations"  # Alembic's steps

BUSY_SECONDS = 15.0  # how long a writer waits for another, unless told
_CONNECTIONS = 90  # beyond the first ten: one for each thread of a busy service
_WRITES = "faience_writes"  # execution option of connections that are going to write


def make_engine(url: str, busy_seconds: float = BUSY_SECONDS) -> Engine:
    """Return an engine for a SQLAlchemy URL, such as ``sqlite:////data/catalogue.db``.

    On SQLite every committed transaction is flushed to the disk before it returns, readers never
    wait for the writer, and writers wait for each other instead of failing half-way.

    Parameters
    ----------
    busy_seconds : float
        For how long; then they are told CatalogueBusy.
    """
    engine = create_engine(url, pool_size=10, max_overflow=_CONNECTIONS)
    if engine.dialect.name == "sqlite":
        event.listen(engine, "connect", partial(_prepare_sqlite, busy_seconds))
        event.listen(engine, "begin", _begin_sqlite)
    return engine


def migrate(engine: Engine, upto: str = "head") -> None:
    """Bring the schema to this version's, or up to one revision; several processes may do so at once."""
    writer = engine.execution_options(**{_WRITES: True})
    with migrations() as config, _named(), writer.connect() as connection:
        _let_tables_be_made_anew(connection)
        with connection.begin():
            before = MigrationContext.configure(connection).get_current_revision()
            config.attributes["connection"] = connection
            command.upgrade(config, upto)
            if before != MigrationContext.configure(connection).get_current_revision():
                _check_keys(connection)


@contextmanager
def migrations() -> Iterator[Config]:
    """Lend Alembic's view of the steps that this version knows."""
    with as_file(SCRIPTS) as scripts:
        config = Config()
        config.set_main_option("script_location", str(scripts).replace("%", "%%"))
        config.set_main_option("path_separator", "os")
        yield config


@contextmanager
def reading(engine: Engine) -> Iterator[Session]:
    """One transaction that sees one moment of the catalogue and changes nothing."""
    with _named(), Session(engine) as session, session.begin():
        yield session


@contextmanager
def looking(engine: Engine) -> Iterator[DBAPICursor]:
    """Do as `reading` does, with the driver's own cursor: for what every search asks."""
    with _named(), _wrapped(engine):
        connection = engine.raw_connection()
        try:
            cursor = connection.cursor()
            if engine.dialect.name == "sqlite":
                cursor.execute("BEGIN")  # other drivers begin by themselves
            yield cursor
        finally:
            connection.close()  # goes back to the pool, which rolls back


@contextmanager
def writing(engine: Engine) -> Iterator[Session]:
    """One transaction that writes; committed and durable when the block ends.

    Raises
    ------
    StorageFull
        The disk is full; nothing was changed.
    CatalogueBusy
        Another process kept the database locked; nothing was changed.
    """
    writer = engine.execution_options(**{_WRITES: True})
    with _named(), Session(writer, expire_on_commit=False) as session, session.begin():
        yield session


def _let_tables_be_made_anew(connection: Connection) -> None:
    # SQLite alters a column by making the table anew. With its foreign keys on, dropping the old table would
    # delete every row that depends on it; inside a transaction they cannot be turned off.
    if connection.dialect.name == "sqlite":
        connection.detach()  # the setting ends with this connection
        connection.connection.cursor().execute("PRAGMA foreign_keys = OFF")


def _check_keys(connection: Connection) -> None:
    if connection.dialect.name != "sqlite":  # others never stop checking
        return
    broken = connection.exec_driver_sql("PRAGMA foreign_key_check").first()
    if broken is not None:
        raise RuntimeError(f"a migration left rows of {broken[0]} without what they refer to in {broken[2]}")


def _prepare_sqlite(busy_seconds: float, connection: sqlite3.Connection, _record: Any) -> None:
    connection.isolation_level = None  # _begin_sqlite says BEGIN; the driver would say it too late
    for pragma in (
        f"busy_timeout = {int(busy_seconds * 1000)}",
        "journal_mode = WAL",
        "synchronous = FULL",  # NORMAL may lose acknowledged commits when the power fails
        "foreign_keys = ON",
    ):
        connection.execute(f"PRAGMA {pragma}")


def _begin_sqlite(connection: Connection) -> None:
    # A transaction that reads first and then wants to write can meet another one doing the same;
    # SQLite would refuse one of them at once, whatever the timeout. So writers say so at the start.
    writes = connection.get_execution_options().get(_WRITES, False)
    connection.exec_driver_sql("BEGIN IMMEDIATE" if writes else "BEGIN")


@contextmanager
def _wrapped(engine: Engine) -> Iterator[None]:
    """Give a driver's failure SQLAlchemy's name, as its own connections do."""
    try:
        yield
    except engine.dialect.loaded_dbapi.OperationalError as error:
        raise OperationalError(None, None, error) from error


@contextmanager
def _named() -> Iterator[None]:
    """Give the two failures that users can do something about their own names."""
    try:
        yield
    except OperationalError as error:
        code = getattr(error.orig, "sqlite_errorcode", 0) & 0xFF  # the low byte is the primary code
        if code == sqlite3.SQLITE_FULL:
            raise StorageFull("the disk is full; nothing was changed") from error
        if code == sqlite3.SQLITE_BUSY:
            raise CatalogueBusy("the catalogue is locked by another process") from error
        raise
