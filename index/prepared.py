"""Prepared statements: SELECTs put together once, which then cost little more than the database's own work.

SQLAlchemy looks at a statement anew each time, which takes longer than SQLite's answer to it; what a search
asks again and again is compiled here once, and read with the driver's own cursor.
"""

from collections.abc import Callable, Mapping
from typing import Any

from sqlalchemy import Dialect, Engine, Select
from sqlalchemy.engine.interfaces import DBAPICursor

Row = list[Any]
Making = Callable[[int], Select[Any]]  # of a statement with so many values in its list


class Prepared:
    """One SELECT for one kind of database.

    Parameters
    ----------
    statement : Select
        With named parameters.
    dialect : Dialect
        Of the engine.
    """

    def __init__(self, statement: Select[Any], dialect: Dialect) -> None:
        compiled = statement.compile(dialect=dialect)
        self._sql = str(compiled)
        self._order = compiled.positiontup  # None where the driver takes names
        kinds = [column.type.dialect_impl(dialect) for column in statement.selected_columns]
        readers = enumerate(kind.result_processor(dialect, None) for kind in kinds)
        self._readers = [(place, reader) for place, reader in readers if reader is not None]

    def rows(self, cursor: DBAPICursor, values: Mapping[str, Any]) -> list[Row]:
        """Return all rows, as SQLAlchemy's types make them."""
        order = self._order
        cursor.execute(self._sql, values if order is None else [values[name] for name in order])
        found = [list(row) for row in cursor.fetchall()]
        for row in found:
            for place, reader in self._readers:
                row[place] = reader(row[place])
        return found


class PreparedLists:
    """One SELECT with a list of values, prepared for each length that comes up.

    Parameters
    ----------
    making : callable
        Makes the statement; its list's parameters are called as `listed` calls them.
    engine : Engine
    """

    def __init__(self, making: Making, engine: Engine) -> None:
        self._making, self._dialect = making, engine.dialect
        self._known: dict[int, Prepared] = {}

    def rows(self, cursor: DBAPICursor, values: Mapping[str, Any], some: list[str]) -> list[Row]:
        """Return all rows for a list, none for an empty one."""
        if not some:
            return []
        known = self._known.get(len(some))
        if known is None:
            known = self._known[len(some)] = Prepared(self._making(len(some)), self._dialect)
        return known.rows(cursor, {**values, **dict(zip(listed(len(some)), some, strict=True))})


def listed(length: int) -> list[str]:
    """Return the names of the parameters of a list."""
    return [f"listed_{place}" for place in range(length)]
