"""Extension: PostgreSQL is asked for pgvector once, at the start."""

from psycopg import Error
from sqlalchemy import Connection, Engine, text
from sqlalchemy.exc import DBAPIError

from index.database import named_failures
from index.errors import NoPgvector
from index.pgvector.names import LOCKS, SCHEMA

OLDEST = (0, 8)  # whose scans of a graph go on until there are enough rows

_HELD = f"""
CREATE TABLE IF NOT EXISTS {SCHEMA}.held (
    method text PRIMARY KEY,
    library text NOT NULL,
    epoch bigint NOT NULL,
    vocabulary_id text,
    revision bigint NOT NULL,
    form text NOT NULL,
    lengths integer[] NOT NULL,
    errors double precision[] NOT NULL,
    number bigint NOT NULL,
    has_graph boolean NOT NULL
)"""


def prepare(engine: Engine) -> None:
    """Make what indexes need beside the catalogue; several processes may do so at once.

    It lies in a schema of its own: no backup needs it, no migration knows it, and it may be dropped at any
    time while nothing runs.

    Raises
    ------
    NoPgvector
        The database is no PostgreSQL, or has no pgvector, or an old one.
    """
    if engine.dialect.name != "postgresql":
        raise NoPgvector(
            "an index in pgvector needs a catalogue in PostgreSQL: set FAIENCE_DATABASE_URL to postgresql://…"
        )
    with named_failures(), engine.begin() as connection:
        connection.execute(text("SELECT pg_advisory_xact_lock(:first, 0)"), {"first": LOCKS})
        _require_extension(connection)
        connection.execute(text(f"CREATE SCHEMA IF NOT EXISTS {SCHEMA}"))
        connection.execute(text(_HELD))


def _require_extension(connection: Connection) -> None:
    version = _version(connection)
    if version is None:
        _create(connection)
        version = _version(connection) or ""
    if tuple(int(part) for part in version.split(".")[:2]) < OLDEST:
        raise NoPgvector(f"pgvector {version} is too old: 0.8 is needed; ALTER EXTENSION vector UPDATE")


def _version(connection: Connection) -> str | None:
    found: str | None = connection.scalar(
        text("SELECT extversion FROM pg_extension WHERE extname = 'vector'")
    )
    return found


def _create(connection: Connection) -> None:
    try:
        with connection.begin_nested():
            connection.execute(text("CREATE EXTENSION vector"))
    except DBAPIError as error:
        if not isinstance(error.orig, Error):
            raise
        raise NoPgvector(
            "this PostgreSQL has no extension pgvector; install it, and let an administrator run "
            f"CREATE EXTENSION vector in the catalogue's database ({str(error.orig).splitlines()[0]})"
        ) from error
