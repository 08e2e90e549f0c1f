"""Grouping: pairs of duplicates become groups in which no pair was dismissed."""

import hashlib
from collections.abc import Collection, Mapping
from dataclasses import dataclass

from index.dismissals import Pair, pair_of
from service.relations.relation import Related, Relation

CLOSEST = tuple(Relation)  # first


@dataclass(frozen=True, kw_only=True)
class Group:
    """Shapes that are duplicates of each other, directly or by way of others among them."""

    members: tuple[str, ...]  # ids, ascending
    pairs: Mapping[Pair, Related]  # those that join them

    @property
    def id(self) -> str:
        """The same for the same members."""
        return hashlib.sha256(" ".join(self.members).encode()).hexdigest()[:16]

    @property
    def relation(self) -> Relation:
        """The loosest that joins two of them."""
        return max((pair.relation for pair in self.pairs.values()), key=CLOSEST.index)


def groups_of(pairs: Mapping[Pair, Related], dismissed: Collection[Pair]) -> list[Group]:
    """Return groups that hold every pair but the dismissed, and never both shapes of a dismissed one.

    A shape that is a duplicate of two that are none of each other is in a group with each.

    Parameters
    ----------
    pairs : mapping of pair to Related
        Those of connected shapes.
    dismissed : collection of pairs
    """
    apart = frozenset(dismissed)
    left = {pair: related for pair, related in sorted(pairs.items()) if pair not in apart}
    groups = []
    uncovered = dict.fromkeys(left)
    while uncovered:
        members = _grown(next(iter(uncovered)), left, apart)
        inside = {pair: related for pair, related in left.items() if members.issuperset(pair)}
        groups.append(Group(members=tuple(sorted(members)), pairs=inside))
        uncovered = {pair: None for pair in uncovered if pair not in inside}
    return groups


def _grown(seed: Pair, pairs: Collection[Pair], apart: Collection[Pair]) -> set[str]:
    """Join to a pair whatever is joined to one of its group and dismissed with none, until nothing is."""
    members = set(seed)
    while True:
        ends = ((near, far) for pair in pairs for near, far in (pair, pair[::-1]))
        joined = sorted({far for near, far in ends if near in members and far not in members})
        fitting = (far for far in joined if not any(pair_of(far, member) in apart for member in members))
        new = next(fitting, None)
        if new is None:
            return members
        members.add(new)
