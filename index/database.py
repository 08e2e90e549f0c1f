"""The database: engine and transactions. SQLite by default, PostgreSQL by its address."""

from collections.abc import Iterator
from contextlib import contextmanager

from sqlalchemy import Engine, make_url
from sqlalchemy.engine.interfaces import DBAPICursor
from sqlalchemy.exc import OperationalError
from sqlalchemy.exc import TimeoutError as PoolExhausted
from sqlalchemy.orm import Session

from index.errors import CatalogueBusy, UnknownDatabase
from index.postgresql import ONE_MOMENT, ONE_MOMENT_SQL, postgresql_engine, postgresql_failure
from index.sqlite import WRITES, sqlite_engine, sqlite_failure

BUSY_SECONDS = 15.0  # how long a writer waits for another, unless told

_ENGINES = {"sqlite": sqlite_engine, "postgresql": postgresql_engine}


def make_engine(url: str, busy_seconds: float = BUSY_SECONDS) -> Engine:
    """Return an engine for a SQLAlchemy URL, such as ``sqlite:////data/catalogue.db``.

    Every committed transaction is durable before it returns, readers never wait for a writer, and writers
    wait for each other instead of failing half-way.

    Parameters
    ----------
    busy_seconds : float
        For how long; then they are told CatalogueBusy.

    Raises
    ------
    UnknownDatabase
        Another kind of database.
    """
    kind = make_url(url).get_backend_name()
    if kind not in _ENGINES:
        raise UnknownDatabase(f"a catalogue is kept in {' or '.join(_ENGINES)}, not in {kind!r:.40}")
    return _ENGINES[kind](url, busy_seconds)


@contextmanager
def reading(engine: Engine) -> Iterator[Session]:
    """One transaction that sees one moment of the catalogue and changes nothing."""
    if engine.dialect.name == "postgresql":  # by default it would show each statement another moment
        engine = engine.execution_options(**ONE_MOMENT)
    with named_failures(), Session(engine) as session, session.begin():
        yield session


@contextmanager
def looking(engine: Engine) -> Iterator[DBAPICursor]:
    """Do as `reading` does, with the driver's own cursor: for what every search asks."""
    # PostgreSQL's driver begins by itself
    begin = "BEGIN" if engine.dialect.name == "sqlite" else ONE_MOMENT_SQL
    with named_failures(), wrapped(engine):
        connection = engine.raw_connection()
        try:
            cursor = connection.cursor()
            cursor.execute(begin)
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
    writer = engine.execution_options(**{WRITES: True})
    with named_failures(), Session(writer, expire_on_commit=False) as session, session.begin():
        yield session


@contextmanager
def named_failures() -> Iterator[None]:
    """Give the failures that users can do something about their own names."""
    try:
        yield
    except OperationalError as error:
        named = sqlite_failure(error) or postgresql_failure(error)
        if named is None:
            raise
        raise named from error
    except PoolExhausted as error:
        raise CatalogueBusy("too many requests wait for the catalogue's database") from error


@contextmanager
def wrapped(engine: Engine) -> Iterator[None]:
    """Give a driver's failure SQLAlchemy's name, as its own connections do."""
    try:
        yield
    except engine.dialect.loaded_dbapi.OperationalError as error:
        raise OperationalError(None, None, error) from error
