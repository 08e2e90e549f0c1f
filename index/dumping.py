"""Dumping: all rows of a library, as they were in one moment."""

from collections.abc import Collection, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from sqlalchemy import Connection, Engine, ForeignKey, RowMapping, Table, func, select
from sqlalchemy.orm import Session

from index.database import reading
from index.rows import stored_files
from index.schema import library_tables, revision_of
from index.shapes import Status, StoredFile
from index.soundness import check_sound
from index.tables import JobRow, ShapeRow

_AT_ONCE = 500  # rows

# A job that is dumped is free: whoever holds it works for the library that it was taken from.
FREE_JOB = {"attempts": 0, "lease_until": None, "claimed_at": None, "worker": None, "token": None}

Place = tuple[str, str]  # a table and its column
Gone = dict[Place, set[Any]]  # of each column that others refer to, the values that are left out
_SHAPE = (ShapeRow.__tablename__, "id")


@dataclass(frozen=True, kw_only=True)
class Belongings:
    """A shape, for those who look after its files."""

    id: str
    revision: int  # of its last change
    ready: bool  # whether files were made of it
    made_in: str | None = None  # folder of these; see Shape
    files: tuple[StoredFile, ...]  # as uploaded


class Moment:
    """A catalogue as it was in one moment, for as long as its transaction lasts."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self._tables = library_tables(session.connection())
        self.revision = revision_of(session.connection())  # of the schema

    def counts(self) -> dict[str, int]:
        """Return the number of rows of each table."""
        connection = self._session.connection()
        return {
            table.name: connection.execute(select(func.count()).select_from(table)).scalar_one()
            for table in self._tables
        }

    def shapes(self) -> Iterator[Belongings]:
        """Yield every shape, ordered by id."""
        last = ""
        while rows := self._shapes_after(last):
            last = rows[-1].id
            for row in rows:
                ready = row.status == Status.READY
                yield Belongings(
                    id=row.id,
                    revision=row.revision,
                    ready=ready,
                    made_in=row.made_in,
                    files=stored_files(row),
                )
            self._session.expunge_all()  # none is held in memory for long

    def tables(self, but: Collection[str] = ()) -> Iterator[tuple[str, Iterator[dict[str, Any]]]]:
        """Yield each table's name and its rows, which must be taken before the next table.

        Parameters
        ----------
        but : collection of str
            Ids of shapes to leave out, with everything that refers to them.
        """
        gone: Gone = {(key.column.table.name, key.column.name): set() for key in self._keys()}
        gone[_SHAPE] = set(but)
        for table in self._tables:
            yield table.name, _rows(self._session.connection(), table, gone)

    def check(self) -> None:
        """Look at every row; DamagedExport for what no import would take."""
        check_sound(self._session)

    def _keys(self) -> Iterator[ForeignKey]:
        for table in self._tables:
            yield from table.foreign_keys

    def _shapes_after(self, last: str) -> list[ShapeRow]:
        query = select(ShapeRow).where(ShapeRow.id > last).order_by(ShapeRow.id).limit(_AT_ONCE)
        return list(self._session.scalars(query))


@contextmanager
def one_moment(engine: Engine) -> Iterator[Moment]:
    """Look at all of a catalogue as it is now, while others go on changing it.

    SQLite keeps what they write in its log until this ends.
    """
    with reading(engine) as session:
        yield Moment(session)


def _rows(connection: Connection, table: Table, gone: Gone) -> Iterator[dict[str, Any]]:
    links = _links(table)
    with connection.execute(select(table), execution_options={"yield_per": _AT_ONCE}) as rows:
        for row in rows.mappings():
            if any(row[name] in gone[place] for name, place in links):
                for name in row:
                    if (table.name, name) in gone:
                        gone[table.name, name].add(row[name])
            else:
                yield _released(table, row)


def _links(table: Table) -> list[tuple[str, Place]]:
    """Return which columns tell that a row is gone: itself a shape, or it refers to what is gone."""
    keys = [(key.parent.name, (key.column.table.name, key.column.name)) for key in table.foreign_keys]
    return [("id", _SHAPE), *keys] if table.name == ShapeRow.__tablename__ else keys


def _released(table: Table, row: RowMapping) -> dict[str, Any]:
    values = dict(row)
    if table.name == JobRow.__tablename__:
        values |= {name: free for name, free in FREE_JOB.items() if name in values}
    if table.name == ShapeRow.__tablename__ and values["status"] == Status.PROCESSING:
        values["status"] = str(Status.QUEUED)
    return values
