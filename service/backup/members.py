"""Which members an archive has: on disk, since there may be hundreds of thousands."""

import sqlite3
from collections.abc import Iterator
from pathlib import Path
from types import TracebackType
from typing import Self

from index.errors import DamagedExport, StorageFull
from service.backup.layout import file_member
from service.backup.writing import Written

_TABLE = """
    CREATE TABLE members (
        position INTEGER PRIMARY KEY,
        name TEXT NOT NULL UNIQUE,
        size INTEGER NOT NULL,
        sha256 TEXT NOT NULL,
        claimed INTEGER NOT NULL DEFAULT 0
    )
"""


class Members:
    """A list of members, in the order of the archive.

    Parameters
    ----------
    folder : Path
        Where it may write; the caller removes it.
    """

    def __init__(self, folder: Path) -> None:
        self._connection = sqlite3.connect(folder / "members.sqlite3", isolation_level=None)
        for statement in ("PRAGMA journal_mode = OFF", "PRAGMA synchronous = OFF", _TABLE, "BEGIN"):
            self._connection.execute(statement)

    def add(self, name: str, written: Written) -> None:
        """Note the next member; DamagedExport where there was one of that name."""
        row = (name, written.size, written.sha256)
        try:
            self._connection.execute("INSERT INTO members (name, size, sha256) VALUES (?, ?, ?)", row)
        except sqlite3.IntegrityError:
            raise DamagedExport(f"the export holds {name!r:.100} twice") from None

    def all(self) -> Iterator[tuple[str, Written]]:
        """Yield the members in their order."""
        for name, size, sha256 in self._connection.execute(
            "SELECT name, size, sha256 FROM members ORDER BY position"
        ):
            yield name, Written(size=size, sha256=sha256)

    def find(self, name: str) -> Written | None:
        """Return what was noted of a member."""
        query = "SELECT size, sha256 FROM members WHERE name = ?"
        row = self._connection.execute(query, (name,)).fetchone()
        return None if row is None else Written(size=row[0], sha256=row[1])

    def claim(self, key: str) -> Written | None:
        """Give a file to the shape that needs it; None where it is not here.

        Raises
        ------
        DamagedExport
            It has been given already.
        """
        name = file_member(key)
        query = "UPDATE members SET claimed = 1 WHERE name = ? AND claimed = 0"
        if not self._connection.execute(query, (name,)).rowcount and self.find(name):
            raise DamagedExport(f"two shapes claim the file {key!r:.100}")
        return self.find(name)

    def claim_below(self, prefix: str) -> None:
        """Give all files whose keys begin like this."""
        start = file_member(prefix)
        end = start[:-1] + chr(ord(start[-1]) + 1)
        self._connection.execute("UPDATE members SET claimed = 1 WHERE name >= ? AND name < ?", (start, end))

    def unclaimed(self) -> str | None:
        """Return the name of a file that belongs to no shape, if there is one."""
        query = "SELECT name FROM members WHERE claimed = 0 AND name >= ? AND name < ? LIMIT 1"
        row = self._connection.execute(query, ("files/", "files0")).fetchone()
        return None if row is None else str(row[0])

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._connection.close()
        if isinstance(error, sqlite3.OperationalError) and error.sqlite_errorcode == sqlite3.SQLITE_FULL:
            raise StorageFull("the disk is full; nothing was imported") from error
