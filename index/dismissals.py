"""Dismissals: pairs of shapes that somebody said are no duplicates, remembered until they take it back."""

from base64 import urlsafe_b64decode, urlsafe_b64encode
from collections.abc import Collection
from dataclasses import dataclass
from datetime import datetime

from sqlalchemy import Engine, or_, select, tuple_
from sqlalchemy.orm import Session

from index.database import reading, writing
from index.errors import BadCursor, DismissalNotFound, NotAPair
from index.revisions import lock_state, now
from index.rows import shape_row
from index.tables import DismissalRow

_AT_ONCE = 400  # ids in one statement

Pair = tuple[str, str]  # ids, the lesser first


@dataclass(frozen=True, kw_only=True)
class Dismissal:
    """A pair of shapes that are no duplicates, whatever their numbers say."""

    one: str  # id, the lesser
    other: str  # id
    created_at: datetime  # UTC


@dataclass(frozen=True, kw_only=True)
class DismissalPage:
    """One page of a list."""

    items: tuple[Dismissal, ...]  # by ids
    next_cursor: str | None  # give it back for the next page; None at the end


def pair_of(one: str, other: str) -> Pair:
    """Return two ids in their order: a pair has no first and second."""
    return (one, other) if one < other else (other, one)


class Dismissals:
    """How what users dismissed is kept; each method is one transaction."""

    _engine: Engine

    def dismiss(self, one: str, other: str) -> Dismissal:
        """Remember that two shapes are no duplicates; one that is remembered keeps its moment.

        Raises
        ------
        ShapeNotFound
        NotAPair
            Both are the same.
        """
        if one == other:
            raise NotAPair("a shape and itself are no pair; name two shapes")
        first, second = pair_of(one, other)
        with writing(self._engine) as session:
            lock_state(session)
            shape_row(session, first)
            shape_row(session, second)
            row = session.get(DismissalRow, (first, second))
            if row is None:
                row = DismissalRow(one=first, other=second, created_at=now())
                session.add(row)
                session.flush()
            return _told(row)

    def undismiss(self, one: str, other: str) -> None:
        """Forget that two shapes are no duplicates; DismissalNotFound where nobody said so."""
        with writing(self._engine) as session:
            lock_state(session)
            row = session.get(DismissalRow, pair_of(one, other))
            if row is None:
                raise DismissalNotFound(f"{one!r:.50} and {other!r:.50} are not dismissed")
            session.delete(row)

    def dismissals(self, limit: int = 50, cursor: str | None = None) -> DismissalPage:
        """Return one page of what was dismissed, by ids.

        Raises
        ------
        BadCursor
            The cursor is not one of ours.
        """
        query = select(DismissalRow).order_by(DismissalRow.one, DismissalRow.other).limit(limit + 1)
        if cursor is not None:
            query = query.where(tuple_(DismissalRow.one, DismissalRow.other) > tuple_(*_pair_in(cursor)))
        with reading(self._engine) as session:
            rows = session.scalars(query).all()
            items = tuple(_told(row) for row in rows[:limit])
        return DismissalPage(items=items, next_cursor=_cursor_of(items[-1]) if len(rows) > limit else None)

    def dismissed_among(self, shape_ids: Collection[str]) -> set[Pair]:
        """Return the dismissed pairs in which one of some shapes stands."""
        wanted = list(shape_ids)
        with reading(self._engine) as session:
            groups = (wanted[start : start + _AT_ONCE] for start in range(0, len(wanted), _AT_ONCE))
            return {pair for group in groups for pair in _pairs_with(session, group)}


def _pairs_with(session: Session, shape_ids: Collection[str]) -> set[Pair]:
    within = or_(DismissalRow.one.in_(shape_ids), DismissalRow.other.in_(shape_ids))
    return {
        (row.one, row.other)
        for row in session.execute(select(DismissalRow.one, DismissalRow.other).where(within))
    }


def _told(row: DismissalRow) -> Dismissal:
    return Dismissal(one=row.one, other=row.other, created_at=row.created_at)


def _cursor_of(last: Dismissal) -> str:
    return urlsafe_b64encode(f"after:{last.one}:{last.other}".encode()).decode()


def _pair_in(cursor: str) -> Pair:
    try:
        word, one, other = urlsafe_b64decode(cursor.encode("ascii")).decode().split(":")
    except ValueError:  # not ASCII, not base 64, not two ids
        raise BadCursor("this cursor does not come from the list of dismissals") from None
    if word != "after":
        raise BadCursor("this cursor does not come from the list of dismissals")
    return one, other
