"""Staging: a catalogue beside the library's, in which rows of an earlier schema become rows of this one."""

from collections.abc import Iterable
from contextlib import ExitStack
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from sqlalchemy import Connection, Engine, Table, insert
from sqlalchemy.exc import IntegrityError

from index.database import make_engine, reading, writing
from index.errors import DamagedExport, NewerFormat
from index.migrating import migrate
from index.portable import readers_of, row_of
from index.schema import is_known, library_tables
from index.soundness import check_sound

_ROWS = 500  # of one statement
_BYTES = 1 << 23  # of one statement, as lines


class Staging:
    """A SQLite database of its own that takes the rows of an export.

    Parameters
    ----------
    folder : Path
        Where it may write; the caller removes it.
    revision : str
        Of the schema that the rows have.

    Raises
    ------
    NewerFormat
        This version does not know the revision.
    """

    def __init__(self, folder: Path, revision: str) -> None:
        if not is_known(revision):
            raise NewerFormat(
                f"the export has the schema {revision!r:.50}, which this version of Faience does not know;"
                " update Faience first"
            )
        self._open = ExitStack()
        self.engine: Engine = make_engine(f"sqlite:///{folder / 'staging.sqlite3'}")
        self._open.callback(self.engine.dispose)
        migrate(self.engine, revision)
        self._filling = self._open.enter_context(ExitStack())
        self._connection: Connection = self._filling.enter_context(writing(self.engine)).connection()
        self._tables = {table.name: table for table in library_tables(self._connection)}
        self._missing = set(self._tables)
        for table in reversed(self._tables.values()):  # a new catalogue has a state of its own
            self._connection.execute(table.delete())

    def load(self, name: str, lines: Iterable[bytes]) -> None:
        """Take the rows of one table, each a line of JSON.

        Raises
        ------
        DamagedExport
            There is no such table in that schema, a line is no row of it, or contradicts another.
        """
        table = self._tables.get(name)
        if table is None:
            raise DamagedExport(f"the export holds a table {name!r:.50} that its schema does not have")
        self._missing.discard(name)
        rows: list[dict[str, Any]] = []
        size, readers = 0, readers_of(table)
        for number, line in enumerate(lines, start=1):
            try:
                rows.append(row_of(line, readers))
            except ValueError as error:
                raise DamagedExport(f"line {number} of the table {name} is no row of it: {error}") from None
            size += len(line)
            if len(rows) >= _ROWS or size >= _BYTES:
                self._insert(table, rows)
                size = 0
        self._insert(table, rows)

    def finish(self) -> None:
        """Bring what was loaded to this version's schema; DamagedExport where it is no sound library."""
        if self._missing:
            raise DamagedExport(f"the export lacks the tables {', '.join(sorted(self._missing))}")
        self._filling.close()
        migrate(self.engine)
        with reading(self.engine) as session:
            check_sound(session)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._open.__exit__(kind, error, trace)

    def _insert(self, table: Table, rows: list[dict[str, Any]]) -> None:
        if not rows:
            return
        try:
            self._connection.execute(insert(table), rows)
        except IntegrityError as error:
            raise DamagedExport(
                f"rows of the table {table.name} contradict others of the export: {error.orig}"
            ) from None
        rows.clear()
