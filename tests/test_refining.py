from collections.abc import Mapping
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from service import refining
from service.refining import QueryLandmarks, Ranked, additions_to, refine, rehearse
from tests.landmarked import Marked, marked
from worker.arrays import SingleArray
from worker.descriptors import registration
from worker.descriptors.registration import register

RANKED = st.lists(st.floats(0.0, 10.0), max_size=12).map(
    lambda distances: [(f"s{k:02}", distance) for k, distance in enumerate(sorted(distances))]
)
ADDITIONS = st.lists(st.floats(0.0, 10.0), min_size=12, max_size=12)


def query_of(shape: Marked) -> QueryLandmarks:
    """Return what a catalogue and its files hold of a query."""
    return QueryLandmarks(packed=shape.packed().ravel(), ladder=shape.ladder.ravel())


QUERY = query_of(marked(0, 20))


def refined(found: Ranked, additions: Mapping[str, float], first: int) -> Ranked:
    """Refine a ranking where registration adds what it is told to."""

    def told(_: QueryLandmarks, stored: Mapping[str, SingleArray]) -> dict[str, float]:
        return {key: additions[key] for key in stored}

    stored = {key: QUERY.packed for key, _ in found[:first] if key in additions}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(refining, "additions_to", told)
        return refine(found, QUERY, stored, first)


def test_what_is_added_is_the_distance_of_the_registration() -> None:
    stored = {seed: marked(seed, 30).packed().ravel() for seed in range(4)}
    query = marked(0, 20)
    assert additions_to(query_of(query), stored) == {
        seed: register(query.query(), marked(seed, 30).stored()).distance() for seed in stored
    }


def test_after_a_rehearsal_nothing_is_compiled_for_a_query() -> None:
    rehearse()
    kernel: Any = registration._all_registered
    ready = list(kernel.signatures)
    additions_to(QUERY, {"a": marked(1, 30).packed().ravel()})
    assert list(kernel.signatures) == ready


def test_a_shape_that_lies_on_the_query_overtakes_nearer_ones() -> None:
    shapes = {f"s{seed}": marked(seed) for seed in range(3)}
    stored = {key: shape.packed() for key, shape in shapes.items()}
    found = [("s2", 0.1), ("s1", 0.2), ("s0", 0.3)]
    assert refine(found, query_of(shapes["s0"]), stored, 3)[0][0] == "s0"


@given(RANKED, ADDITIONS, st.integers(0, 15))
def test_results_are_ordered_by_their_sums(found: Ranked, added: list[float], first: int) -> None:
    additions = {key: extra for (key, _), extra in zip(found, added, strict=False)}
    answer = refined(found, additions, first)
    distances = [distance for _, distance in answer]
    assert distances == sorted(distances)
    assert {key for key, _ in answer[:first]} == {key for key, _ in found[:first]}
    for key, distance in answer[:first]:
        assert distance == dict(found)[key] + additions[key]


@given(RANKED, ADDITIONS, st.integers(0, 15))
def test_those_not_looked_at_follow_in_their_order_with_the_worst_addition(
    found: Ranked, added: list[float], first: int
) -> None:
    additions = {key: extra for (key, _), extra in zip(found, added, strict=False)}
    worst = max(added[: len(found[:first])], default=0.0)
    tail = [(key, distance + worst) for key, distance in found[first:]]
    assert refined(found, additions, first)[first:] == tail


def test_equal_sums_are_ordered_by_id() -> None:
    found = [("b", 1.0), ("c", 1.0), ("d", 1.5), ("a", 2.0)]
    answer = refined(found, {"a": 0.0, "b": 1.0, "c": 1.0, "d": 0.5}, 4)
    assert answer == [("a", 2.0), ("b", 2.0), ("c", 2.0), ("d", 2.0)]


def test_a_shape_removed_meanwhile_drops_out() -> None:
    found = [("a", 1.0), ("b", 2.0), ("c", 3.0)]
    assert refined(found, {"b": 0.5, "c": 9.0}, 2) == [("b", 2.5), ("c", 3.5)]
    assert refined(found, {}, 2) == [("c", 3.0)]
    assert refined([], {}, 2) == []
