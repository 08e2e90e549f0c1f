"""Tags: words in a shape's metadata by which people sort their shapes."""

from base64 import urlsafe_b64decode, urlsafe_b64encode
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from sqlalchemy import ColumnElement, Engine, delete, func, select
from sqlalchemy.orm import Session

from index.database import reading
from index.errors import BadCursor
from index.rows import folded, storable
from index.tables import ShapeRow, TagRow

FIELD = "tags"  # of metadata: a list of words, or one
LONGEST, MOST = 200, 100  # characters of a tag, tags of a shape; what goes beyond stays metadata alone


@dataclass(frozen=True, kw_only=True)
class Tag:
    """A tag, and how often it is used."""

    name: str  # as it was written first, among capitals and small letters
    shapes: int  # that have it


@dataclass(frozen=True, kw_only=True)
class TagPage:
    """One page of the tags of a library."""

    items: tuple[Tag, ...]  # the most used first
    next_cursor: str | None  # give it back for the next page; None at the end


class Tags:
    """How tags are told."""

    _engine: Engine

    def tags(self, limit: int = 100, cursor: str | None = None, q: str | None = None) -> TagPage:
        """Return one page of tags, the most used first.

        Parameters
        ----------
        limit : int
            Tags on a page, at least 1.
        cursor : str, optional
            What the page before gave.
        q : str, optional
            Only tags that begin with this text; capitals do not matter.

        Raises
        ------
        BadCursor
            The cursor is not one of ours.
        """
        start = 0 if cursor is None else _place_of(cursor)
        number = func.count().label("number")
        query = select(TagRow.folded, func.min(TagRow.shown), number).group_by(TagRow.folded)
        if q:
            query = query.where(TagRow.folded.startswith(folded(q), autoescape=True))
        query = query.order_by(number.desc(), TagRow.folded).offset(start).limit(limit + 1)
        with reading(self._engine) as session:
            found = [Tag(name=shown, shapes=count) for _, shown, count in session.execute(query)]
        more = len(found) > limit
        return TagPage(items=tuple(found[:limit]), next_cursor=_cursor_of(start + limit) if more else None)


def tags_of(metadata: Mapping[str, Any]) -> dict[str, str]:
    """Return the tags in a shape's metadata: what is compared → what is shown."""
    given = metadata.get(FIELD)
    words = [given] if isinstance(given, str) else given if isinstance(given, list) else []
    known: dict[str, str] = {}
    for word in words:
        shown = " ".join(storable(word).split()) if isinstance(word, str) else ""
        if shown and len(shown) <= LONGEST:
            known.setdefault(folded(shown), shown)
    return dict(list(known.items())[:MOST])


def write_tags(session: Session, row: ShapeRow) -> None:
    """Keep a shape's tags in step with its metadata, in the transaction that changes that."""
    session.flush()  # a new shape is there before its tags
    session.execute(delete(TagRow).where(TagRow.shape_id == row.id))
    for compared, shown in tags_of(row.user_metadata).items():
        session.add(TagRow(shape_id=row.id, folded=compared, shown=shown))


def having(tags: Iterable[str]) -> list[ColumnElement[bool]]:
    """Return the conditions that a shape has each of some tags."""
    return [
        ShapeRow.id.in_(select(TagRow.shape_id).where(TagRow.folded == folded(" ".join(tag.split()))))
        for tag in tags
    ]


def _cursor_of(place: int) -> str:
    return urlsafe_b64encode(f"tag:{place}".encode()).decode()


def _place_of(cursor: str) -> int:
    try:
        word, _, digits = urlsafe_b64decode(cursor.encode("ascii")).decode("ascii").partition(":")
        place = int(digits)
    except ValueError:  # not ASCII, not base 64, not a number
        raise BadCursor("this cursor does not come from the list of tags") from None
    if word != "tag" or not 0 <= place < 1 << 63:
        raise BadCursor("this cursor does not come from the list of tags")
    return place
