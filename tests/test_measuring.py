"""Distances follow their formula, the second stage is that of a search, refusals harm nobody else."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from index.blocks import decode_block, encode_block
from index.methods import METHODS, Block, Method
from service.evaluation.cache import Cache, Described
from service.evaluation.measuring import GalleryRefused, Loaded, first_stage, load, measure
from service.evaluation.protocol import Geometry, Query, Recipe
from service.evaluation.scores import score
from service.evaluation.suites import Entry, Suite
from service.refining import LANDMARKS, refine
from tests.evaluations import InThisProcess
from tests.test_registering import landmarks, made

N_SHAPES = 6
SIZES = {"log-hks": 8, "colour-histogram": 20, "colour-curves": 9, "hks-0": 5, "hks-0.05": 5, "hks-0.1": 5}
FUSED = replace(METHODS["fused"], refined=3)
REFUSED = Described(blocks={}, refused="no_faces: the mesh holds no faces")


def described(seed: int) -> Described:
    random = np.random.default_rng(seed)
    blocks = {name: random.uniform(0, 1, size).astype(np.float32) for name, size in SIZES.items()}
    return Described(blocks=made(seed).blocks | blocks)


def recipe(name: str) -> Recipe:
    return Recipe(geometry=Geometry(model=name, source=f"{name}.ply"))


def suite_of(n_queries: int = 4) -> Suite:
    queries = tuple(
        Query(model=f"shape {k % 3}", transformation="hue", strength=1 + k // 3, recipe=recipe(f"query {k}"))
        for k in range(n_queries)
    )
    gallery = tuple(Entry(name=f"shape {k}", recipe=recipe(f"shape {k}")) for k in range(N_SHAPES))
    return Suite(test="paper", title="t", explanation="e", queries=queries, gallery=gallery)


def loaded(queries: Sequence[Described]) -> Loaded:
    suite = suite_of(len(queries))
    shapes = tuple(described(k) for k in range(N_SHAPES))
    return Loaded(suite=suite, entries=suite.gallery, shapes=shapes, queries=tuple(queries))


def by_hand(method: Method, query: Described, shape: Described) -> float:
    total = 0.0
    for block in method.blocks:
        pairs = zip(query.blocks[block.name].tolist(), shape.blocks[block.name].tolist(), strict=True)
        total += block.weight * sum(abs(x - y) for x, y in pairs) ** block.power
    return total


@pytest.fixture
def cache(tmp_path: Path) -> Cache:
    """Hold a whole test; the files of its meshes stand for themselves."""
    suite, cache = suite_of(), Cache(tmp_path / "cache", tmp_path, ())
    for seed, each in enumerate(suite.recipes()):
        (tmp_path / each.geometry.source).write_text(each.geometry.model)
        cache.store(each, described(seed))
    return cache


@pytest.mark.parametrize("name", ["fused", "chks", "hks", "colour-histogram"])
def test_distances_equal_the_formula_by_hand(name: str) -> None:
    method = replace(METHODS[name], refined=0)
    test = loaded([described(10 + k) for k in range(4)])
    expected = [[by_hand(method, query, shape) for shape in test.shapes] for query in test.queries]
    found = measure(InThisProcess(), test, [method], {}).distances[name]
    np.testing.assert_allclose(found, expected, rtol=1e-9)
    np.testing.assert_allclose(first_stage(METHODS[name], test.queries, test.shapes), expected, rtol=1e-9)


def test_what_is_loaded_is_what_an_index_keeps(cache: Cache) -> None:
    found = load(suite_of(), cache)
    recipes = [entry.recipe for entry in found.entries] + [query.recipe for query in found.suite.queries]
    for described, recipe in zip((*found.shapes, *found.queries), recipes, strict=True):
        exact = cache.load(recipe).blocks
        for name in SIZES:
            kept = decode_block(encode_block(name, exact[name]))
            np.testing.assert_array_equal(described.blocks[name], kept, strict=True)


def test_a_second_stage_gives_the_distances_of_a_search() -> None:
    test = loaded([described(10 + k) for k in range(4)])
    found = measure(InThisProcess(), test, [FUSED], {}).distances["fused"]
    for query, row, before in zip(
        test.queries, found, first_stage(FUSED, test.queries, test.shapes), strict=True
    ):
        ranked = sorted(((str(k), float(before[k])) for k in range(N_SHAPES)), key=lambda pair: pair[1])
        stored = {key: test.shapes[int(key)].blocks[LANDMARKS] for key, _ in ranked[: FUSED.refined]}
        refined = refine(ranked, landmarks(query), stored, FUSED.refined)
        assert {str(k): row[k] for k in range(N_SHAPES)} == pytest.approx(dict(refined), rel=1e-9)
        assert [str(k) for k in np.argsort(row, kind="stable")] == [key for key, _ in refined]


def test_a_gallery_smaller_than_the_second_stage_is_registered_whole() -> None:
    test = loaded([described(10)])
    pool = InThisProcess()
    measure(pool, test, [METHODS["fused"]], {})
    ((((_, _, stored),),),) = pool.submitted
    assert set(stored) == {entry.recipe for entry in test.entries}


def test_what_one_test_registered_another_does_not() -> None:
    test, pool = loaded([described(10), described(11)]), InThisProcess()
    additions: dict[tuple[Recipe, Recipe], float] = {}
    first, again = (measure(pool, test, [FUSED], additions) for _ in range(2))
    assert len(pool.submitted) == 1
    np.testing.assert_array_equal(first.distances["fused"], again.distances["fused"])


def test_an_outcome_asks_what_its_test_asks() -> None:
    test = loaded([described(10 + k) for k in range(4)])
    outcome = measure(InThisProcess(), test, [METHODS["hks"]], {})
    assert (outcome.test, outcome.title, outcome.explanation) == ("paper", "t", "e")
    assert outcome.gallery == tuple(entry.name for entry in test.entries)
    for question, query in zip(outcome.questions, test.suite.queries, strict=True):
        for part in ("name", "model", "transformation", "strength"):
            assert getattr(question, part) == getattr(query, part)


def test_a_refused_query_ranks_its_answer_last() -> None:
    test = loaded([described(0), REFUSED, described(2)])
    outcome = measure(InThisProcess(), test, [FUSED, METHODS["chks"]], {})
    for scores in score(outcome).values():
        assert scores.ranks.tolist() == [1, N_SHAPES, 1]


def test_a_test_of_nothing_but_refused_queries_is_measured_too() -> None:
    outcome = measure(InThisProcess(), loaded([REFUSED, REFUSED]), [FUSED], {})
    assert np.isinf(outcome.distances["fused"]).all()


def test_what_is_cached_is_loaded_in_order(cache: Cache) -> None:
    suite = suite_of()
    found = load(suite, cache)
    assert found.entries == suite.gallery
    for seed, each in enumerate((*found.shapes, *found.queries)):
        np.testing.assert_array_equal(each.blocks["hks-0"], described(seed).blocks["hks-0"])


def test_refused_clutter_is_left_out(cache: Cache) -> None:
    suite = suite_of()
    cache.store(suite.gallery[4].recipe, REFUSED)
    found = load(suite, cache)
    assert [entry.name for entry in found.entries] == [f"shape {k}" for k in (0, 1, 2, 3, 5)]
    np.testing.assert_array_equal(found.shapes[4].blocks["hks-0"], described(5).blocks["hks-0"])
    assert measure(InThisProcess(), found, [FUSED], {}).distances["fused"].shape == (4, 5)


def test_a_refused_model_is_a_failure_that_names_its_file(cache: Cache) -> None:
    suite = suite_of()
    cache.store(suite.gallery[2].recipe, REFUSED)
    with pytest.raises(GalleryRefused, match=r"shape 2\.ply: no_faces"):
        load(suite, cache)


def test_a_refused_query_is_loaded_with_its_reason(cache: Cache) -> None:
    suite = suite_of()
    cache.store(suite.queries[1].recipe, REFUSED)
    assert [query.refused for query in load(suite, cache).queries] == [None, REFUSED.refused, None, None]


def test_powers_are_of_the_whole_block() -> None:
    method = Method(name="m", blocks=(Block(name="hks-0", weight=3.0, power=2),), description="")
    ones, zeros = (Described(blocks={"hks-0": np.full(5, value, np.float32)}) for value in (1.0, 0.0))
    assert first_stage(method, [ones], [zeros]).tolist() == [[3.0 * 5.0**2]]
