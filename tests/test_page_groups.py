"""What is left of a group on the page is what the service would give: one rule, tried on the same pairs."""

import random
from collections.abc import Iterator
from itertools import combinations
from typing import Any

import pytest
from playwright.sync_api import Browser, Page

from index.dismissals import pair_of
from service.relations.grouping import groups_of
from service.relations.relation import Evidence, Related, Relation
from tests.modules import modules

SCRIPT = """async ({ group, dismissed, removed }) => {
  const { leftOf, keyOf } = await import("/static/duplicates/groups.js");
  const keys = new Set(dismissed.map(([one, other]) => keyOf(other, one)));
  return leftOf(group, keys, new Set(removed)).map(({ shapes, relation, evidence }) =>
    [shapes.map(({ id }) => id), relation, evidence.length]);
}"""


@pytest.fixture(scope="module")
def page(browser: Browser) -> Iterator[Page]:
    with modules(browser) as page:
        yield page


def related(relation: Relation) -> Related:
    evidence = Evidence(
        shape_distance=0,
        colour_distance=0,
        pattern_distance=0,
        pose_distance=None,
        misfit=None,
        part=None,
        same_file=False,
    )
    return Related(relation=relation, evidence=evidence)


def as_json(pairs: dict[tuple[str, str], Related]) -> dict[str, Any]:
    ids = sorted({member for pair in pairs for member in pair})
    evidence = [
        {"one": one, "other": other, "relation": {"name": kind.relation}}
        for (one, other), kind in sorted(pairs.items())
    ]
    return {"shapes": [{"id": member} for member in ids], "evidence": evidence}


def test_what_is_left_is_what_the_service_would_give(page: Page) -> None:
    chance = random.Random(6)  # noqa: S311 - a draw of tests
    for _ in range(60):
        every = list(combinations("abcdefg"[: chance.randint(2, 7)], 2))
        joined = chance.sample(every, chance.randint(1, len(every)))
        pairs = {pair: related(chance.choice(list(Relation))) for pair in joined}
        dismissed = chance.sample(every, chance.randint(0, len(every) // 2))
        wanted = [
            [list(group.members), group.relation.value, len(group.pairs)]
            for group in groups_of(pairs, {pair_of(*pair) for pair in dismissed})
        ]
        asked = {"group": as_json(pairs), "dismissed": dismissed, "removed": []}
        assert page.evaluate(SCRIPT, asked) == wanted


def test_a_removed_shape_leaves_the_others_only_where_they_are_joined(page: Page) -> None:
    chain = {("a", "b"): related(Relation.RECOLOURED), ("b", "c"): related(Relation.SAME_SHAPE)}
    asked: dict[str, Any] = {"group": as_json(chain), "dismissed": [], "removed": ["b"]}
    assert page.evaluate(SCRIPT, asked) == []
    assert page.evaluate(SCRIPT, asked | {"removed": ["a"]}) == [[["b", "c"], "same_shape", 1]]
