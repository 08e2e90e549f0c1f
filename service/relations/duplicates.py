"""Duplicates: the groups of a library, found a few shapes at a time, and never removed by themselves."""

from base64 import urlsafe_b64decode, urlsafe_b64encode
from collections import deque
from collections.abc import Collection, Iterator
from dataclasses import dataclass, field
from typing import Literal

from index.dismissals import Pair, pair_of
from index.errors import BadBlock, BadCursor, NotReady, ShapeNotFound
from index.shapes import Shape
from service.asking import Question, near_without_refining
from service.library import Library
from service.relations.grouping import Group, groups_of
from service.relations.relating import relate_stored
from service.relations.relation import Related, Relation
from service.vocabularies import known_vocabulary

Kind = Literal[
    Relation.SAME_FILE, Relation.SAME_SHAPE, Relation.RECOLOURED, Relation.RE_POSED
]  # of duplicates
USUAL: tuple[Kind, ...] = (Relation.SAME_FILE, Relation.SAME_SHAPE, Relation.RECOLOURED)
NEAREST = 24  # shapes that each is compared with, by each way of asking
WORK = 50  # shapes that a page looks at, about
MOST = 60  # shapes of a group, about: of more, those that are nearest to the first are told
WAYS = (  # of asking: by everything, and by the surface alone, for copies in other colours
    Question(limit=NEAREST),
    Question(limit=NEAREST, weights={"colour-histogram": 0.0, "colour-curves": 0.0}),
)


@dataclass(frozen=True, kw_only=True)
class Duplicates:
    """One group, with its shapes."""

    group: Group
    shapes: tuple[Shape, ...]  # in the order of the group's members


@dataclass(frozen=True, kw_only=True)
class DuplicatesPage:
    """One page of groups."""

    items: tuple[Duplicates, ...]  # by the least id of what is connected
    looked: int  # shapes that the page has passed
    next_cursor: str | None  # give it back for the next page; None at the end


@dataclass(kw_only=True)
class _Look:
    """One look at the library: what was asked before is not asked again."""

    library: Library
    wanted: frozenset[Relation]
    told: dict[Pair, Related | None] = field(default_factory=dict)
    asked: dict[str, dict[Pair, Related]] = field(default_factory=dict)  # id → what is joined to it
    known: dict[str, dict[Pair, Related]] = field(default_factory=dict)  # id → what is connected to it

    def joined(self, shape_id: str) -> dict[Pair, Related]:
        """Return a shape's pairs with those near it: of a wanted relation, and not dismissed."""
        if shape_id not in self.asked:
            near = {pair_of(shape_id, other): other for other in _near(self.library, shape_id)}
            dismissed = self.library.catalogue.dismissed_among([shape_id]) if near else set()
            self._tell(shape_id, [other for pair, other in near.items() if pair not in self.told])
            found = {pair: self.told.get(pair) for pair in near if pair not in dismissed}
            self.asked[shape_id] = {
                pair: related
                for pair, related in found.items()
                if related is not None and related.relation in self.wanted
            }
        return self.asked[shape_id]

    def _tell(self, shape_id: str, others: list[str]) -> None:
        """Compare a shape with others, each pair once."""
        vocabulary_id = known_vocabulary(self.library.catalogue.state().vocabulary_id)
        related = relate_stored(self.library, shape_id, others, vocabulary_id, parts=False)
        self.told |= {pair_of(shape_id, other): related.get(other) for other in others}

    def connected(self, shape_id: str) -> dict[Pair, Related]:
        """Return the pairs by which a shape is connected to others, directly or by way of them."""
        if shape_id in self.known:
            return self.known[shape_id]
        pairs: dict[Pair, Related] = {}
        reached, waiting = {shape_id}, deque([shape_id])
        while waiting and len(reached) <= MOST:
            found = self.joined(waiting.popleft())
            pairs |= found
            new = {member for pair in found for member in pair} - reached
            reached |= new
            waiting += sorted(new)
        self.known[shape_id] = pairs
        return pairs


def find_duplicates(
    library: Library,
    limit: int = 20,
    cursor: str | None = None,
    relations: Collection[Kind] = USUAL,
    work: int = WORK,
) -> DuplicatesPage:
    """Return one page of groups of duplicates.

    Shapes are looked at in the order of their ids, about ``work`` of them for a page: it may hold fewer
    groups than asked for, even none, while there are more pages. Each is compared with its NEAREST alone.

    Parameters
    ----------
    limit : int
        Groups at most, at least 1; all that are made of the same connected shapes come together.
    cursor : str, optional
        What the page before gave.
    relations : collection of Kind
        By which shapes are joined.
    work : int
        Shapes that are asked for what is near them, about.

    Raises
    ------
    BadCursor
        The cursor is not one of ours.
    NoVocabulary, VocabularyChanged
    """
    look = _Look(library=library, wanted=frozenset(relations))
    items: list[Duplicates] = []
    last = "" if cursor is None else _id_in(cursor)
    looked = 0
    for looked, shape_id in enumerate(library.catalogue.ready_after(last, work), start=1):  # noqa: B007 - the last number is the count
        last = shape_id
        items += _groups_at(look, shape_id)
        if len(items) >= limit or len(look.asked) >= work:
            break
    more = bool(library.catalogue.ready_after(last, 1)) if last else False
    return DuplicatesPage(items=tuple(items), looked=looked, next_cursor=_cursor_of(last) if more else None)


def _groups_at(look: _Look, shape_id: str) -> Iterator[Duplicates]:
    """Yield the groups of what is connected to a shape, unless a shape before it leads here as well.

    Being near is not mutual: a shape with many copies may not have all of those near that have it near.
    """
    pairs = look.connected(shape_id)
    members = {member for pair in pairs for member in pair}
    if any(shape_id in pair for m in sorted(members) if m < shape_id for pair in look.connected(m)):
        return
    for group in groups_of(pairs, look.library.catalogue.dismissed_among(members)):
        shapes = look.library.catalogue.get_many(group.members)
        if len(shapes) == len(group.members):  # otherwise one was removed in this moment
            yield Duplicates(group=group, shapes=tuple(shapes[member] for member in group.members))


def _near(library: Library, shape_id: str) -> list[str]:
    """Return what lies near a shape; nothing where it was removed meanwhile, or lacks a block."""
    try:
        return list({found: None for way in WAYS for found in near_without_refining(library, shape_id, way)})
    except (ShapeNotFound, NotReady, BadBlock):
        return []


def _cursor_of(shape_id: str) -> str:
    return urlsafe_b64encode(f"from:{shape_id}".encode()).decode()


def _id_in(cursor: str) -> str:
    try:
        word, _, shape_id = urlsafe_b64decode(cursor.encode("ascii")).decode().partition(":")
    except ValueError:  # not ASCII, not base 64, not text
        raise BadCursor("this cursor does not come from the duplicates") from None
    if word != "from" or not shape_id:
        raise BadCursor("this cursor does not come from the duplicates")
    return shape_id
