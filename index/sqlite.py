"""SQLite: how its connections are prepared, and what its failures mean."""

import sqlite3
from functools import partial
from typing import Any

from sqlalchemy import Connection, Engine, create_engine, event
from sqlalchemy.exc import OperationalError

from index.errors import CatalogueBusy, StorageFull

WRITES = "faience_writes"  # execution option of connections that are going to write
_CONNECTIONS = 90  # beyond the first ten: one for each thread of a busy service


def sqlite_engine(url: str, busy_seconds: float) -> Engine:
    """Return an engine whose commits are flushed to the disk, and whose readers never wait for the writer."""
    engine = create_engine(url, pool_size=10, max_overflow=_CONNECTIONS)
    event.listen(engine, "connect", partial(_prepare, busy_seconds))
    event.listen(engine, "begin", _begin)
    return engine


def sqlite_failure(error: OperationalError) -> Exception | None:
    """Return the failure that users can do something about, by its own name; None for any other."""
    code = getattr(error.orig, "sqlite_errorcode", 0) & 0xFF  # the low byte is the primary code
    if code == sqlite3.SQLITE_FULL:
        return StorageFull("the disk is full; nothing was changed")
    if code == sqlite3.SQLITE_BUSY:
        return CatalogueBusy("the catalogue is locked by another process")
    return None


def let_tables_be_made_anew(connection: Connection) -> None:
    """Turn foreign keys off for a migration, for as long as this connection lasts.

    SQLite alters a column by making the table anew. With its foreign keys on, dropping the old table would
    delete every row that depends on it; inside a transaction they cannot be turned off.
    """
    connection.detach()  # the setting ends with this connection
    connection.connection.cursor().execute("PRAGMA foreign_keys = OFF")


def check_keys(connection: Connection) -> None:
    """Look at every reference after a migration; RuntimeError where one leads nowhere."""
    broken = connection.exec_driver_sql("PRAGMA foreign_key_check").first()
    if broken is not None:
        raise RuntimeError(f"a migration left rows of {broken[0]} without what they refer to in {broken[2]}")


def _prepare(busy_seconds: float, connection: sqlite3.Connection, _record: Any) -> None:
    connection.isolation_level = None  # _begin says BEGIN; the driver would say it too late
    for pragma in (
        f"busy_timeout = {int(busy_seconds * 1000)}",
        "journal_mode = WAL",
        "synchronous = FULL",  # NORMAL may lose acknowledged commits when the power fails
        "foreign_keys = ON",
    ):
        connection.execute(f"PRAGMA {pragma}")


def _begin(connection: Connection) -> None:
    # A transaction that reads first and then wants to write can meet another one doing the same;
    # SQLite would refuse one of them at once, whatever the timeout. So writers say so at the start.
    writes = connection.get_execution_options().get(WRITES, False)
    connection.exec_driver_sql("BEGIN IMMEDIATE" if writes else "BEGIN")
