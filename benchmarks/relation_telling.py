"""Telling relations of many pairs, in a process of its own."""

import time
from collections.abc import Iterable
from dataclasses import dataclass

from benchmarks.relation_meshes import Variant
from benchmarks.relation_numbers import Kept
from service.relations.evidence import relate_sides
from service.relations.relation import Relation
from service.relations.sides import Side

NONE = "none"  # told where a preview cannot be read

Pair = tuple[Variant, Variant, Relation]  # and the true relation


@dataclass(frozen=True, kw_only=True)
class Told:
    """What was told of one pair."""

    part: str  # of the measurement
    true: Relation
    told: str
    milliseconds: float


def told_of(kept: Kept, pairs: Iterable[Pair]) -> list[Told]:
    """Return what is told of each pair."""
    sides: dict[Variant, Side] = {}
    found = []
    for one, other, true in pairs:
        for variant in (one, other):
            if variant not in sides:
                sides[variant] = kept.side(variant)
        start = time.perf_counter()
        related = relate_sides(sides[one], sides[other])
        milliseconds = 1000.0 * (time.perf_counter() - start)
        told = NONE if related is None else str(related.relation)
        found.append(Told(part=one.part, true=true, told=told, milliseconds=milliseconds))
    return found
