"""Many queries are registered as one is, and no pair twice."""

import numpy as np
import pytest

from service.evaluation.cache import Described
from service.evaluation.protocol import Geometry, Recipe
from service.evaluation.registering import TOGETHER, Additions, additions_of
from service.refining import LANDMARKS, QUERY_LADDER, QueryLandmarks, additions_to
from tests.evaluations import InThisProcess
from worker.descriptors.landmarks import LADDER, WIDTH

POINTS = 12


def made(seed: int) -> Described:
    """Return the landmarks of a shape, at random."""
    random = np.random.default_rng(seed)
    rows = random.normal(0, 1, (POINTS, WIDTH))
    rows[:, 6:9] = random.normal([50, 0, 0], 15, (POINTS, 3))
    rows[:, -1] = 1 / POINTS
    ladder = np.cumsum(random.uniform(-0.4, 0.0, (POINTS, len(LADDER))), axis=1)
    blocks = {LANDMARKS: rows.ravel(), QUERY_LADDER: ladder}
    return Described(blocks={name: block.astype(np.float32) for name, block in blocks.items()})


def recipe(name: str) -> Recipe:
    return Recipe(geometry=Geometry(model=name, source=name))


SHAPES = {recipe(f"shape {k}"): made(k) for k in range(4)}
QUERIES = {recipe(f"query {k}"): made(100 + k) for k in range(2 * TOGETHER + 1)}


def landmarks(described: Described) -> QueryLandmarks:
    return QueryLandmarks(packed=described.blocks[LANDMARKS], ladder=described.blocks[QUERY_LADDER])


def test_every_wanted_pair_gets_what_registration_adds() -> None:
    known: Additions = {}
    near = list(SHAPES)[1:3]
    additions_of(InThisProcess(), {q: (d, near) for q, d in QUERIES.items()}, SHAPES, known)
    assert known.keys() == {(query, shape) for query in QUERIES for shape in near}
    for query, described in list(QUERIES.items())[::7]:
        expected = additions_to(landmarks(described), {s: SHAPES[s].blocks[LANDMARKS] for s in near})
        assert {shape: known[query, shape] for shape in near} == pytest.approx(expected)


def test_what_is_known_is_not_computed_again() -> None:
    (query, described), *_ = QUERIES.items()
    first, second, *_ = SHAPES
    known: Additions = {(query, first): -1.0}
    pool = InThisProcess()
    additions_of(pool, {query: (described, [first, second])}, SHAPES, known)
    assert known[query, first] == -1.0
    ((((_, _, stored),),),) = pool.submitted
    assert list(stored) == [second]
    additions_of(pool, {query: (described, [first, second])}, SHAPES, known)
    assert len(pool.submitted) == 1


def test_jobs_are_of_even_size() -> None:
    pool = InThisProcess()
    additions_of(pool, {q: (d, [next(iter(SHAPES))]) for q, d in QUERIES.items()}, SHAPES, {})
    assert [len(group) for (group,) in pool.submitted] == [TOGETHER, TOGETHER, 1]
