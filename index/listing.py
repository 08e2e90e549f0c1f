"""Listing: shapes one by one, and page by page."""

from base64 import urlsafe_b64decode, urlsafe_b64encode
from collections.abc import Mapping, Sequence
from typing import Any, TypeVar

from sqlalchemy import Engine, Select, false, func, select

from index.database import reading
from index.errors import BadCursor
from index.rows import folded, shape_of, shape_row
from index.shapes import Page, Shape, Status
from index.tables import FileRow, ShapeRow
from index.tags import having

Some = TypeVar("Some", bound=Select[*tuple[Any, ...]])

_LONGEST = 12_000  # signs of a filter; SQLite refuses patterns over 50 000 bytes


class Listing:
    """How shapes are looked up."""

    _engine: Engine

    def get(self, shape_id: str) -> Shape:
        """Return one shape; ShapeNotFound where there is none."""
        with reading(self._engine) as session:
            return shape_of(shape_row(session, shape_id))

    def list(
        self,
        limit: int = 50,
        cursor: str | None = None,
        status: Status | None = None,
        q: str | None = None,
        tags: Sequence[str] = (),
    ) -> Page:
        """Return one page, newest first.

        Parameters
        ----------
        limit : int
            Shapes on a page, at least 1.
        cursor : str, optional
            What the page before gave; pages stay in step while shapes are added or removed.
        status : Status, optional
            Only shapes in this state.
        q : str, optional
            Only shapes whose name or metadata values contain this text; capitals do not matter.
        tags : sequence of str
            Only shapes that have all of these tags; capitals do not matter.

        Raises
        ------
        BadCursor
            The cursor is not one of ours.
        """
        query = select(ShapeRow).order_by(ShapeRow.sequence.desc()).limit(limit + 1)
        if status is not None:
            query = query.where(ShapeRow.status == status)
        if cursor is not None:
            query = query.where(ShapeRow.sequence < _sequence_of(cursor))
        with reading(self._engine) as session:
            rows = session.scalars(_filtered(query, q, tags)).all()
            items = tuple(shape_of(row) for row in rows[:limit])
            more = len(rows) > limit
            return Page(items=items, next_cursor=_cursor_of(rows[limit - 1].sequence) if more else None)

    def ready_after(self, shape_id: str, limit: int) -> tuple[str, ...]:
        """Return the ids of the next ready shapes in the order of ids, "" for the first."""
        ready = select(ShapeRow.id).where(ShapeRow.status == Status.READY, ShapeRow.id > shape_id)
        with reading(self._engine) as session:
            return tuple(session.scalars(ready.order_by(ShapeRow.id).limit(limit)))

    def counts(self, q: str | None = None, tags: Sequence[str] = ()) -> Mapping[Status, int]:
        """Return how many shapes are in each state, of all or of those that `list` would show."""
        query = select(ShapeRow.status, func.count()).group_by(ShapeRow.status)
        with reading(self._engine) as session:
            rows = session.execute(_filtered(query, q, tags))
            found = {Status(status): count for status, count in rows}
        return {status: found.get(status, 0) for status in Status}

    def file_keys(self) -> set[str]:
        """Return every key of the file store that a shape's files need."""
        with reading(self._engine) as session:
            return set(session.scalars(select(FileRow.key)))


def _filtered(query: Some, q: str | None, tags: Sequence[str]) -> Some:
    query = query.where(*having(tags))
    if not q:
        return query
    text = folded(q)
    contained = ShapeRow.searchable.contains(text, autoescape=True)
    return query.where(contained if len(text) <= _LONGEST else false())


def _cursor_of(sequence: int) -> str:
    return urlsafe_b64encode(f"before:{sequence}".encode()).decode()


def _sequence_of(cursor: str) -> int:
    try:
        word, _, digits = urlsafe_b64decode(cursor.encode("ascii")).decode("ascii").partition(":")
        sequence = int(digits)
    except ValueError:  # not ASCII, not base 64, not a number
        raise BadCursor("this cursor does not come from the list of shapes") from None
    if word != "before" or not 0 <= sequence < 1 << 63:
        raise BadCursor("this cursor does not come from the list of shapes")
    return sequence
