from pathlib import Path

import pytest

from service.evaluation.folder import Folder, Model
from service.evaluation.protocol import BENT, PARTIAL
from service.evaluation.sources import MADE
from service.evaluation.suites import MADE_SHAPES, SWAPPED, TWINS, Suite, null_shapes, suites, twins_of

FOLDER = Folder(
    path=Path("folder"),
    models=tuple(Model(name=f"m{k}", rest=f"m{k}/0.ply", others=(f"m{k}/1.ply",)) for k in range(16)),
    clutter=("clutter/a.ply", "clutter/b.obj"),
)


def found(*, twins: bool = False, hard: bool = False) -> dict[str, Suite]:
    return {suite.test: suite for suite in suites(FOLDER, twins=twins, hard=hard)}


def test_each_option_adds_its_tests() -> None:
    assert list(found()) == ["paper"]
    assert list(found(twins=True)) == ["paper", "twins", "combined"]
    assert list(found(hard=True)) == ["paper", "twins", "combined", "swapped", "large"]
    assert list(found(twins=True, hard=True)) == list(found(hard=True))


def test_the_gallery_of_the_paper_is_rest_poses_and_clutter_as_they_are() -> None:
    gallery = null_shapes(FOLDER)
    assert [entry.recipe.geometry.source for entry in gallery] == [
        *(f"m{k}/0.ply" for k in range(16)),
        "clutter/a.ply",
        "clutter/b.obj",
    ]
    for entry in gallery:
        assert (entry.recipe.geometry.damage, entry.recipe.coat, entry.recipe.changes) == ("whole", None, ())
    assert found()["paper"].gallery == gallery


@pytest.mark.parametrize("test", ["paper", "twins", "combined", "swapped", "large"])
def test_every_query_has_one_right_answer_and_every_name_is_unique(test: str) -> None:
    suite = found(hard=True)[test]
    names = [entry.name for entry in suite.gallery]
    assert len(set(names)) == len(names)
    assert {query.model for query in suite.queries} == {model.name for model in FOLDER.models}
    assert {query.model for query in suite.queries} <= set(names)
    assert len({query.name for query in suite.queries}) == len(suite.queries)


def test_galleries_grow_by_what_their_names_say() -> None:
    tests = found(hard=True)
    plain = len(tests["paper"].gallery)
    assert len(tests["twins"].gallery) == plain + 16 * TWINS
    assert len(tests["swapped"].gallery) == plain + 16 * 32  # the first multiple of 16 that is 500 or more
    assert len(tests["large"].gallery) == plain + MADE_SHAPES
    assert 16 * 31 < SWAPPED <= 16 * 32


def test_harder_tests_ask_the_papers_queries_but_for_the_combined_ones() -> None:
    tests = found(hard=True)
    for test in ("twins", "swapped", "large"):
        assert tests[test].queries == tests["paper"].queries
    damages = {query.recipe.geometry.damage for query in tests["combined"].queries}
    assert damages == {BENT, PARTIAL}


def test_twins_share_the_geometry_of_the_rest_pose_and_wear_different_coats() -> None:
    rests = {entry.name: entry.recipe.geometry for entry in null_shapes(FOLDER)}
    twins = twins_of(FOLDER.models, 3)
    for twin in twins:
        assert twin.recipe.geometry == rests[twin.recipe.geometry.model]
    assert len({(twin.recipe.geometry, twin.recipe.coat) for twin in twins}) == 3 * 16
    few, many = (twins_of(FOLDER.models, count) for count in (2, 5))
    assert {twin.recipe for twin in few} <= {twin.recipe for twin in many}  # described once for both tests


def test_shapes_made_by_code_are_all_different() -> None:
    made = [entry for entry in found(hard=True)["large"].gallery if entry.name.startswith(MADE)]
    assert {entry.recipe.geometry.source for entry in made} == {f"{MADE}{k}" for k in range(MADE_SHAPES)}


def test_recipes_are_those_of_gallery_and_queries() -> None:
    suite = found(twins=True)["twins"]
    recipes = list(suite.recipes())
    assert len(recipes) == len(suite.gallery) + len(suite.queries)
    assert set(recipes) == {e.recipe for e in suite.gallery} | {q.recipe for q in suite.queries}


def test_a_few_models_have_more_twins_each() -> None:
    one = Folder(path=FOLDER.path, models=FOLDER.models[:1], clutter=())
    swapped = suites(one, twins=False, hard=True)[3]
    assert len(swapped.gallery) == 1 + SWAPPED
