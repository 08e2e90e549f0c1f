"""Libraries as earlier versions left them: rows in every table, in the schema of any migration."""

from pathlib import Path
from typing import Any

from sqlalchemy import Engine, MetaData, inspect, select

from index import migrating
from index.database import make_engine, writing
from index.dismissals import pair_of
from index.key_secrets import digest_of
from index.migrating import migrate
from index.postgresql import go_on_after
from index.revisions import now
from index.tables import ApiKeyRow, Base
from tests.brute_force import add
from tests.catalogues import Opened, add_queued, open_catalogue
from tests.databases import DATABASES

REVISIONS = sorted(
    path.name[1:5] for path in (Path(migrating.__file__).parent / "migrations" / "versions").glob("r*.py")
)
Rows = dict[str, list[dict[str, Any]]]  # of each table, as the database gives them


def fill(opened: Opened) -> None:
    """Bring rows into every table of a catalogue, but that of renewals."""
    shapes = [add(opened, number) for number in range(5)]
    for name in ("removed", "failed", "held", "waiting"):
        add_queued(opened, name, tags=["Vase", "old"], year=2011)
        if name == "removed":
            opened.catalogue.remove(name)
        elif name != "waiting":
            job = opened.queue.claim("worker", 3600)
            if job is None:
                raise RuntimeError("expected a job")
            if name == "failed":
                opened.catalogue.record_failed(job, code="zero_area", detail="it has no area")
    opened.catalogue.dismiss(*pair_of(*shapes[:2]))
    key = {"id": "k", "name": "Anna", "digest": digest_of(b"secret"), "scope": "read", "created_at": now()}
    with writing(opened.engine) as session:
        session.add(ApiKeyRow(**key, revoked_at=None))


def rows_of(engine: Engine) -> Rows:
    """Return every row of every table of this project, in an order of their own."""
    with engine.connect() as connection:
        return {
            table.name: sorted((dict(row) for row in connection.execute(select(table)).mappings()), key=repr)
            for table in _tables(engine)
        }


def library_at(folder: Path, revision: str) -> tuple[Engine, Rows]:
    """Make a filled library in the schema of a migration; return what it holds."""
    with_all = folder / "filled"
    with_all.mkdir(parents=True)
    opened = open_catalogue(with_all)
    fill(opened)
    rows = rows_of(opened.engine)
    opened.engine.dispose()
    (folder / "earlier").mkdir()
    engine = make_engine(DATABASES.url(folder / "earlier"))
    migrate(engine, revision)
    _put(engine, rows)
    return engine, rows_of(engine)


def schema_of(engine: Engine) -> dict[str, Any]:
    """Return all that a database tells of its tables."""
    found = inspect(engine)
    return {
        name: {
            "columns": {
                column["name"]: (str(column["type"]), column["nullable"], column["default"])
                for column in found.get_columns(name)
            },
            "key": found.get_pk_constraint(name),
            "indexes": _sorted(found.get_indexes(name)),
            "uniques": _sorted(found.get_unique_constraints(name)),
            "references": _sorted(found.get_foreign_keys(name)),
            "checks": _sorted(found.get_check_constraints(name)),
        }
        for name in sorted(found.get_table_names())
    }


def _put(engine: Engine, rows: Rows) -> None:
    """Replace what a database holds by those columns of the rows that it has."""
    tables = _tables(engine)
    with writing(engine) as session:
        connection = session.connection()
        for table in reversed(tables):
            connection.execute(table.delete())
        for table in tables:
            known = {column.name for column in table.columns}
            some = [{name: row[name] for name in row if name in known} for row in rows[table.name]]
            if some:
                connection.execute(table.insert(), some)
            if connection.dialect.name == "postgresql":
                go_on_after(connection, table)


def _tables(engine: Engine) -> list[Any]:
    metadata = MetaData()
    metadata.reflect(engine)
    return [table for table in metadata.sorted_tables if table.name in Base.metadata.tables]


def _sorted(parts: list[Any]) -> list[Any]:
    return sorted(parts, key=repr)
