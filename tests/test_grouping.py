"""Groups hold every pair but the dismissed, and never both shapes of a dismissed one."""

from itertools import combinations

from hypothesis import given
from hypothesis import strategies as st

from service.relations.grouping import Group, groups_of
from service.relations.relation import Related, Relation
from tests.test_deciding import SAME

IDS = "abcdefg"
ALL = list(combinations(IDS, 2))


def joined(*pairs: str, relation: Relation = Relation.SAME_SHAPE) -> dict[tuple[str, str], Related]:
    return {(pair[0], pair[1]): Related(relation=relation, evidence=SAME) for pair in pairs}


def members(groups: list[Group]) -> list[str]:
    return ["".join(group.members) for group in groups]


@given(st.sets(st.sampled_from(ALL)), st.sets(st.sampled_from(ALL)))
def test_every_pair_is_in_a_group_and_no_dismissed_one_is(
    pairs: set[tuple[str, str]], dismissed: set[tuple[str, str]]
) -> None:
    groups = groups_of(joined(*map("".join, pairs)), dismissed)
    inside = {pair for group in groups for pair in combinations(group.members, 2)}
    assert pairs - dismissed <= inside
    assert not inside & dismissed
    assert {pair for group in groups for pair in group.pairs} == pairs - dismissed


@given(st.sets(st.sampled_from(ALL), min_size=1))
def test_without_dismissals_groups_are_the_connected_shapes(pairs: set[tuple[str, str]]) -> None:
    groups = groups_of(joined(*map("".join, pairs)), ())
    for one, other in combinations(groups, 2):
        assert not set(one.members) & set(other.members)


def test_a_shape_between_two_that_were_dismissed_is_in_a_group_with_each() -> None:
    assert members(groups_of(joined("ab", "bc", "ac"), {("a", "c")})) == ["ab", "bc"]


def test_a_chain_is_one_group() -> None:
    assert members(groups_of(joined("ab", "bc", "cd"), ())) == ["abcd"]


def test_a_group_is_called_by_its_loosest_relation() -> None:
    pairs = (
        joined("ab") | joined("bc", relation=Relation.RECOLOURED) | joined("cd", relation=Relation.SAME_FILE)
    )
    (group,) = groups_of(pairs, ())
    assert group.relation is Relation.RECOLOURED


def test_an_id_follows_from_the_members_alone() -> None:
    (one,), (same,), (other,) = (
        groups_of(joined("ab", "bc"), ()),
        groups_of(joined("ac", "bc", relation=Relation.RECOLOURED), ()),
        groups_of(joined("ab"), ()),
    )
    assert one.id == same.id != other.id
