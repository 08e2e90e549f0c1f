"""Deciding: each relation needs all of its evidence, and the closest one is told."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from service.relations.deciding import BENT, COLOUR, FITS, PATTERN, POSE, relation_of
from service.relations.relation import Evidence, Part, Relation

SAME = Evidence(
    shape_distance=0.0,
    colour_distance=0.0,
    pattern_distance=0.0,
    pose_distance=0.0,
    misfit=0.0,
    part=None,
    same_file=True,
)


@pytest.mark.parametrize(
    ("changes", "relation"),
    [
        ({}, Relation.SAME_FILE),
        ({"same_file": False}, Relation.SAME_SHAPE),
        ({"colour_distance": COLOUR / 2}, Relation.SAME_SHAPE),
        ({"shape_distance": 0.01}, Relation.SAME_SHAPE),
        ({"misfit": FITS, "same_file": False}, Relation.SAME_SHAPE),
        ({"colour_distance": 2 * COLOUR}, Relation.RECOLOURED),
        ({"pattern_distance": 2 * PATTERN}, Relation.RECOLOURED),
        ({"misfit": BENT}, Relation.RE_POSED),
        ({"pose_distance": POSE, "misfit": None}, Relation.RE_POSED),
        ({"misfit": (FITS + BENT) / 2}, Relation.SIMILAR),
        ({"misfit": BENT, "colour_distance": 2 * COLOUR}, Relation.SIMILAR),
        ({"pose_distance": POSE, "misfit": None, "pattern_distance": 2 * PATTERN}, Relation.SIMILAR),
        ({"pose_distance": None, "misfit": None}, Relation.SIMILAR),
        ({"pose_distance": None, "misfit": 1.0, "part": Part.QUERY}, Relation.PART_OF),
    ],
)
def test_the_evidence_names_the_relation(changes: dict[str, float | None], relation: Relation) -> None:
    assert relation_of(replace(SAME, **changes)) is relation  # type: ignore[arg-type]


@given(
    st.builds(
        Evidence,
        shape_distance=st.floats(0.0, 0.065),
        colour_distance=st.floats(0.0, 1.0),
        pattern_distance=st.floats(0.0, 2.0),
        pose_distance=st.floats(0.0, 1.0),
        misfit=st.floats(0.0, 10.0),
        part=st.none(),
        same_file=st.booleans(),
    ),
    st.floats(0.0, 1.0),
)
def test_other_colours_never_bring_two_shapes_closer(evidence: Evidence, more: float) -> None:
    order = list(Relation)
    further = replace(evidence, colour_distance=evidence.colour_distance + more)
    assert order.index(relation_of(further)) >= order.index(relation_of(evidence))


@given(st.floats(0.0, 10.0), st.floats(0.0, 10.0))
def test_a_larger_misfit_is_never_called_the_same_pose(one: float, other: float) -> None:
    unbent = {Relation.SAME_FILE, Relation.SAME_SHAPE, Relation.RECOLOURED}
    near, far = sorted((one, other))
    if relation_of(replace(SAME, misfit=far)) in unbent:
        assert relation_of(replace(SAME, misfit=near)) in unbent
