"""PostgreSQL: how its connections are prepared, and what its failures mean."""

import time
from collections.abc import Mapping
from functools import partial
from select import POLLIN, poll
from typing import Any

from psycopg import Connection as Driver
from psycopg import Error as DriverError
from psycopg.types.string import StrBinaryDumper, StrDumper
from sqlalchemy import Connection, Engine, Table, create_engine, event, func, make_url, select, text
from sqlalchemy.exc import InvalidatePoolError, OperationalError
from sqlalchemy.pool import ConnectionPoolEntry

from index.errors import CatalogueBusy, StorageFull

ONE_MOMENT: Mapping[str, Any] = {"isolation_level": "REPEATABLE READ", "postgresql_readonly": True}
ONE_MOMENT_SQL = "SET TRANSACTION ISOLATION LEVEL REPEATABLE READ READ ONLY"

_KEPT, _MORE = 5, 15  # connections of a process; a server has a hundred by default, for all of them
_TEXT = {"client_encoding": "utf8"}  # a server made without a locale would have bytes sent and received
_TRUSTED = 5.0  # seconds after its last use in which a silent connection is taken to be a living one
_MIGRATING = 0x666169656E6365  # the name of a lock that one migration at a time holds: "faience"
_FULL, _BUSY = frozenset({"53100"}), frozenset({"55P03", "40P01", "40001", "57P03", "53300"})


class _Sendable(StrDumper):
    """Text as PostgreSQL takes it: no NUL, no half characters; no row can hold them, so none is found."""

    def dump(self, obj: str) -> bytes:
        """Return the text in UTF-8."""
        return bytes(super().dump(sendable(obj)) or b"")


class _SendableBinary(StrBinaryDumper):
    """The same for values that travel in binary form."""

    def dump(self, obj: str) -> bytes:
        """Return the text in UTF-8."""
        return bytes(super().dump(sendable(obj)) or b"")


def postgresql_engine(url: str, busy_seconds: float) -> Engine:
    """Return an engine that notices a restarted server; writers wait only so long for each other."""
    address = make_url(url).set(drivername="postgresql+psycopg")
    engine = create_engine(address, pool_size=_KEPT, max_overflow=_MORE, connect_args=_TEXT)
    event.listen(engine, "connect", partial(_prepare, busy_seconds))
    event.listen(engine, "checkin", _note_use)
    event.listen(engine, "checkout", _ask_whether_alive)
    return engine


def postgresql_failure(error: OperationalError) -> Exception | None:
    """Return the failure that users can do something about, by its own name; None for any other."""
    state = getattr(error.orig, "sqlstate", None)  # None where no server answers
    if state in _FULL:
        return StorageFull("the disk of the database server is full; nothing was changed")
    if state in _BUSY:
        return CatalogueBusy("the catalogue is locked, or its server has too much to do")
    return None


def migrate_one_at_a_time(connection: Connection) -> None:
    """Wait until no other process migrates; the lock ends with the transaction."""
    connection.execute(text("SELECT pg_advisory_xact_lock(:name)"), {"name": _MIGRATING})


def go_on_after(connection: Connection, table: Table) -> None:
    """Let a table's sequence give no id that a row was copied with."""
    for column in table.primary_key:
        asked = {"table": table.name, "column": column.name}
        name = connection.scalar(text("SELECT pg_get_serial_sequence(:table, :column)"), asked)
        if name is not None:
            last = connection.scalar(select(func.max(column)))
            connection.execute(
                text("SELECT setval(:name, :last, :used)"),
                {"name": name, "last": last or 1, "used": last is not None},
            )


def sendable(words: str) -> str:
    """Return a text without what PostgreSQL cannot take."""
    return words.replace("\0", "\ufffd").encode("utf-8", "replace").decode()


def _prepare(busy_seconds: float, connection: Driver[Any], _record: Any) -> None:
    for dumper in (_Sendable, _SendableBinary):
        connection.adapters.register_dumper(str, dumper)
    connection.execute(f"SET lock_timeout = {int(busy_seconds * 1000)}")
    connection.execute("SET timezone = 'UTC'")
    connection.commit()


def _note_use(_connection: Driver[Any], record: ConnectionPoolEntry) -> None:
    record.info["used"] = time.monotonic()


def _ask_whether_alive(connection: Driver[Any], record: ConnectionPoolEntry, _borrower: object) -> None:
    """Ask only where the server may have gone: the question would cost each transaction a way there and back.

    A server that stops or restarts says so on every connection, one that is cut off is silent.
    """
    used = record.info.get("used")
    if used is None or (time.monotonic() - used < _TRUSTED and not _spoke(connection)):
        return
    try:
        connection.execute("")
        connection.rollback()
    except DriverError as error:
        raise InvalidatePoolError from error  # the pool connects anew


def _spoke(connection: Driver[Any]) -> bool:
    if connection.closed:
        return True
    waiting = poll()
    waiting.register(connection.fileno(), POLLIN)
    return bool(waiting.poll(0))
