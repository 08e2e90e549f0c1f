"""Which queries there are, and that everything random in them follows from names alone."""

import subprocess
import sys
from collections import Counter
from pathlib import Path

import numpy as np
import pytest

from service.evaluation.folder import Model
from service.evaluation.photometric import PHOTOMETRIC
from service.evaluation.protocol import (
    BENT,
    COMBINED,
    ISOMETRY,
    MIXED,
    PARTIAL,
    PARTIALITY,
    STRENGTHS,
    TRANSFORMATIONS,
    WHOLE,
    Geometry,
    Query,
    combined_queries,
    paper_queries,
    random_of,
)

SCRIPT = """
from tests.test_protocol import MODELS, fingerprint
print(fingerprint())
"""
MODELS = tuple(
    Model(name=f"m{k}", rest=f"m{k}/pose_00.ply", others=tuple(f"m{k}/pose_{i:02d}.ply" for i in range(1, 7)))
    for k in range(16)
)


def fingerprint() -> str:
    """Return everything that queries and draws follow from, as text."""
    queries = [*paper_queries(MODELS), *combined_queries(MODELS)]
    return f"{queries} {random_of('m0', BENT, 3).integers(2**62, size=4)}"


def rows(queries: list[Query], row: str) -> list[Query]:
    return [query for query in queries if query.transformation == row]


def kind(change: str) -> str:
    return change.rstrip("+-")


def test_sixteen_models_give_880_queries_in_eleven_rows() -> None:
    queries = paper_queries(MODELS)
    assert len(queries) == 880
    assert len({query.name for query in queries}) == 880
    counts = Counter((query.transformation, query.strength) for query in queries)
    assert counts == dict.fromkeys([(row, s) for row in TRANSFORMATIONS for s in STRENGTHS], 16)
    assert len(TRANSFORMATIONS) == 11


def test_combined_queries_are_two_rows_with_two_changes_of_light() -> None:
    queries = combined_queries(MODELS)
    assert Counter(query.transformation for query in queries) == dict.fromkeys(COMBINED, 80)
    assert {len(query.recipe.changes) for query in queries} == {2}
    assert {query.recipe.geometry.damage for query in queries} == {BENT, PARTIAL}


@pytest.mark.parametrize("row", PHOTOMETRIC)
def test_a_change_of_light_leaves_the_geometry_to_the_rest_pose(row: str) -> None:
    for query in rows(paper_queries(MODELS), row):
        model = next(model for model in MODELS if model.name == query.model)
        assert query.recipe.geometry == Geometry(model=model.name, source=model.rest, damage=WHOLE)
        assert query.recipe.changes == (row,)
        assert query.recipe.strength == query.strength


def test_damage_alone_changes_no_colour() -> None:
    for row, damage in ((ISOMETRY, BENT), (PARTIALITY, PARTIAL)):
        for query in rows(paper_queries(MODELS), row):
            assert query.recipe.changes == ()
            assert query.recipe.geometry.damage == damage
            assert query.recipe.geometry.strength == query.strength


def test_mixed_queries_share_their_geometry_with_isometry_and_topology() -> None:
    queries = [*paper_queries(MODELS), *combined_queries(MODELS)]
    bent = [query.recipe.geometry for query in rows(queries, ISOMETRY)]
    for row in (MIXED, f"{ISOMETRY}, two photometric"):
        assert [query.recipe.geometry for query in rows(queries, row)] == bent
    cut = [query.recipe.geometry for query in rows(queries, PARTIALITY)]
    assert [query.recipe.geometry for query in rows(queries, f"{PARTIALITY}, two photometric")] == cut


def test_a_model_is_bent_into_another_pose_at_each_strength() -> None:
    for model in MODELS:
        queries = rows(paper_queries([model]), ISOMETRY)
        sources = [query.recipe.geometry.source for query in queries]
        assert len(set(sources)) == 5
        assert set(sources) <= set(model.others)


@pytest.mark.parametrize("n_others", [0, 1, 2])
def test_few_poses_are_used_again(n_others: int) -> None:
    model = Model(name="m", rest="rest", others=("a", "b")[:n_others])
    sources = [query.recipe.geometry.source for query in rows(paper_queries([model]), ISOMETRY)]
    assert set(sources) == set(model.others or ("rest",))


def test_two_changes_are_never_of_the_same_kind() -> None:
    drawn = [query.recipe.changes for query in rows(paper_queries(MODELS), MIXED)]
    assert all(kind(first) != kind(second) for first, second in drawn)
    assert {change for pair in drawn for change in pair} == set(PHOTOMETRIC)


def test_models_and_strengths_differ_in_what_is_drawn() -> None:
    draws = [tuple(random_of(model.name, s).integers(2**62, size=2)) for model in MODELS for s in STRENGTHS]
    assert len(set(draws)) == len(draws)
    mixed = rows(paper_queries(MODELS), MIXED)
    assert len({query.recipe.changes for query in mixed}) > 20
    poses = [query.recipe.geometry.source[-6:] for query in rows(paper_queries(MODELS), ISOMETRY)]
    assert len(set(map(tuple, np.reshape(poses, (16, 5)).tolist()))) > 12


def test_draws_follow_from_names_alone_in_any_process() -> None:
    command = [sys.executable, "-c", SCRIPT]
    folder = Path(__file__).parents[1]
    found = subprocess.run(command, capture_output=True, check=True, cwd=folder, text=True).stdout
    assert found == fingerprint() + "\n"


def test_other_models_beside_it_do_not_change_a_models_queries() -> None:
    alone, among = paper_queries(MODELS[3:4]), paper_queries(MODELS)
    assert {query.name: query for query in alone}.items() <= {query.name: query for query in among}.items()
