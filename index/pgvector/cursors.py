"""Cursors of PostgreSQL's driver, for what SQLAlchemy has no words for: vectors and COPY."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, cast

import psycopg
from sqlalchemy import Engine

from index.database import looking, wrapped, writing
from index.pgvector.names import LOCKS

Cursor = psycopg.Cursor[tuple[Any, ...]]


@contextmanager
def reading_cursor(engine: Engine) -> Iterator[Cursor]:
    """One transaction that sees one moment and changes nothing."""
    with looking(engine) as cursor:
        yield cast("Cursor", cursor)


@contextmanager
def writing_cursor(engine: Engine) -> Iterator[Cursor]:
    """One transaction that writes; committed when the block ends."""
    with writing(engine) as session, wrapped(engine):
        driver = session.connection().connection.driver_connection
        with cast("psycopg.Connection[tuple[Any, ...]]", driver).cursor() as cursor:
            yield cursor


def wait_for_turn(cursor: Cursor, number: int) -> None:
    """Wait until no other transaction holds the lock of this number; it is held until this one ends."""
    cursor.execute("SELECT pg_advisory_xact_lock(%s, %s)", [LOCKS, number])
