"""The second stage of a search: the first results are registered with the query and ordered anew."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from worker.arrays import SingleArray
from worker.descriptors.landmarks import LADDER, WIDTH
from worker.descriptors.registration import query_of, register_all

LANDMARKS = "landmarks"  # block of every shape
QUERY_LADDER = "landmark-ladder"  # signature of the query
Key = TypeVar("Key")  # of a shape
Ranked = list[tuple[str, float]]  # ids and distances, nearest first


@dataclass(frozen=True, kw_only=True, eq=False)
class QueryLandmarks:
    """A query's points, with heat at all times that registration may try."""

    packed: SingleArray  # the block LANDMARKS
    ladder: SingleArray  # the signature QUERY_LADDER


def refine(found: Ranked, query: QueryLandmarks, stored: Mapping[str, SingleArray], first: int) -> Ranked:
    """Add to each distance how badly the shape's landmarks can be brought onto the query's.

    Those after the first ones are given the worst of their additions: the order stays one of distance, and
    nobody gains by not having been looked at.

    Parameters
    ----------
    found : list of (id, distance)
        Nearest first.
    query : QueryLandmarks
    stored : mapping of id to array
        The block LANDMARKS of the first shapes; those without it, since removed, drop out.
    first : int
        How many are registered.

    Returns
    -------
    list of (id, distance)
        Nearest first, equal distances by id.
    """
    additions = additions_to(query, stored)
    worst = max(additions.values(), default=0.0)
    refined = sorted(
        ((i, distance + additions[i]) for i, distance in found[:first] if i in additions),
        key=lambda result: (result[1], result[0]),
    )
    return refined + [(shape_id, distance + worst) for shape_id, distance in found[first:]]


def rehearse() -> None:
    """Load the compiled functions of this stage; on a machine's first start they are compiled."""
    packed, ladder = np.ones(2 * WIDTH, np.float32), np.ones(2 * len(LADDER), np.float32)
    additions_to(QueryLandmarks(packed=packed, ladder=ladder), {"": 2.0 * packed})


def additions_to(query: QueryLandmarks, stored: Mapping[Key, SingleArray]) -> dict[Key, float]:
    """Return what registration adds to the distance of each shape: exactly 0 for the same landmarks."""
    other = {key: block for key, block in stored.items() if not np.array_equal(block, query.packed)}
    if not other:
        return dict.fromkeys(stored, 0.0)
    ready = query_of(query.ladder.reshape(-1, len(LADDER)), query.packed)
    found = register_all(ready, np.stack(list(other.values())))
    distances = [registration.distance() for registration in found]
    return dict.fromkeys(stored, 0.0) | dict(zip(other, distances, strict=True))
