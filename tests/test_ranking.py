from collections.abc import Collection, Iterator
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from index import candidates, ranking, sketch, vectors
from index.arrays import DoubleArray, PositionArray, RowArray
from index.distances import distances, levels_of
from index.layout import Layout
from index.methods import Method, with_weights
from index.ranking import Ranked, rank
from index.vectors import Vectors
from tests.layouts import byte_layout, clustered_rows, random_rows, single_layout

LAYOUTS = [
    byte_layout(1, (3, 9, 5)),
    byte_layout(2, (4, 6)),
    single_layout(1, (6, 8, 3)),
    single_layout(2, (3, 9, 5)),
    single_layout(2, (12,)),
]
seeds = st.integers(0, 2**32 - 1)
layouts = st.sampled_from(LAYOUTS)


@pytest.fixture(autouse=True, scope="module")
def small() -> Iterator[None]:
    """Let small libraries have sketches, of small boxes and few groups."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(vectors, "SKETCHED", 20)
        patch.setattr(sketch, "BOX", 8)
        patch.setattr(candidates, "BOX", 8)
        patch.setattr(candidates, "LIKELY", 3)
        patch.setattr(sketch, "COARSE", 4)
        patch.setattr(sketch, "FINE", 7)
        patch.setattr(sketch, "MERGED", 2)
        patch.setattr(ranking, "FIRST", 2)
        patch.setattr(ranking, "SECOND", 3)
        yield


def filled(layout: Layout, rows: RowArray, seed: int = 0, late: int = 0) -> Vectors:
    """Return rows under ids in random order, the last of them after the order was made."""
    ids = [f"{number:05}" for number in np.random.default_rng(seed).permutation(len(rows))]
    made = Vectors(layout)
    for start, end in pairwise([0, len(rows) - late, len(rows)]):
        made.put(ids[start:end], rows[start:end])
        if not start:
            made.settle()
    return made


def by_comparing_all(
    found: Vectors, query: RowArray, limit: int, exclude: Collection[str] = (), method: Method | None = None
) -> Ranked:
    of_all = distances(found.rows, found.here, query, found.layout, method or found.layout.method).tolist()
    ids = [found.ids[position] for position in found.here]
    answer = sorted((d, shape_id) for d, shape_id in zip(of_all, ids, strict=True) if shape_id not in exclude)
    return [(shape_id, d) for d, shape_id in answer[: max(limit, 0)]]


def slow_distance(layout: Layout, row: RowArray, query: RowArray) -> float:
    """Compare number by number, block by block: exact where sums have no rounding."""
    gaps = np.abs(levels_of(row[None], layout) - levels_of(query[None], layout))[0]
    total = 0.0
    for weight, (start, end) in zip(layout.weights(layout.method), pairwise(layout.edges), strict=True):
        total += float(weight) * float(sum(gaps[start:end].tolist())) ** layout.method.power
    return total


def few_different(layout: Layout, n_rows: int, n_different: int, seed: int) -> RowArray:
    """Return rows of which many are equal, and whose distances often are."""
    generator = np.random.default_rng(seed)
    different = generator.integers(0, 3, (n_different, layout.width)).astype(layout.dtype)
    return different[generator.integers(0, n_different, n_rows)]


@given(
    layout=layouts,
    n_rows=st.integers(1, 300),
    n_different=st.integers(1, 40),
    limit=st.integers(-1, 320),
    seed=seeds,
)
@settings(max_examples=200)
def test_the_certified_answer_is_that_of_brute_force_ties_and_exclusions_included(
    layout: Layout, n_rows: int, n_different: int, limit: int, seed: int
) -> None:
    generator = np.random.default_rng(seed)
    found = filled(layout, few_different(layout, n_rows, n_different, seed), seed)
    query = few_different(layout, 1, 1, seed + 1)[0]
    exclude = set(generator.choice([*found.ids, "unknown"], generator.integers(0, n_rows + 1)).tolist())
    slow = [
        (slow_distance(layout, row, query), shape_id)
        for row, shape_id in zip(found.rows, found.ids, strict=True)
        if shape_id not in exclude
    ]
    expected = [(shape_id, d) for d, shape_id in sorted(slow)[: max(limit, 0)]]
    assert rank(found, query, limit, exclude) == expected


@given(layout=layouts, seed=seeds, limit=st.sampled_from([1, 3, 10, 100]), late=st.integers(0, 60))
@settings(max_examples=100)
def test_removed_rows_are_not_found_and_late_ones_are(
    layout: Layout, seed: int, limit: int, late: int
) -> None:
    rows = clustered_rows(layout, 240, 6, seed)
    found = filled(layout, rows, seed, late)
    assert found.sketch is not None
    found.remove(np.random.default_rng(seed).choice(list(found.ids), 80, replace=False).tolist())
    for query in (rows[0], rows[-1], random_rows(layout, 1, seed)[0]):
        assert rank(found, query, limit) == by_comparing_all(found, query, limit)


@given(layout=layouts, seed=seeds, data=st.data(), limit=st.integers(1, 40))
@settings(max_examples=150)
def test_own_weights_give_the_answer_of_brute_force(
    layout: Layout, seed: int, data: st.DataObject, limit: int
) -> None:
    weight = st.sampled_from([0.0, 1e-9, 0.5, 1.0, 7.0, 1e9])
    own = {block.name: data.draw(weight) for block in layout.method.blocks}
    if not any(own.values()):
        own[layout.method.blocks[-1].name] = 1.0
    method = with_weights(layout.method, own)
    found = filled(layout, clustered_rows(layout, 250, 5, seed), seed)
    query = found.rows[seed % 250]
    assert rank(found, query, limit, method=method) == by_comparing_all(found, query, limit, method=method)


@given(
    seed=seeds,
    power=st.sampled_from([1, 2]),
    scale=st.sampled_from([1e-42, 1e-38, 1e-30, 1e-20, 1e-3, 1.0, 1e10, 1e19, 1e30, 3e38]),
    offset=st.sampled_from([0.0, 1.0]),
    spread=st.sampled_from([1.0, 1e-4, 1e-7]),
)
@settings(max_examples=150)
def test_numbers_of_any_size_rank_as_comparing_all_does(
    seed: int, power: int, scale: float, offset: float, spread: float
) -> None:
    layout = single_layout(power, (4, 20, 9))
    generator = np.random.default_rng(seed)
    middles = generator.random((4, layout.width))[generator.integers(0, 4, 300)]
    values = middles + generator.choice([0.01, 1.0]) * generator.normal(size=middles.shape)
    rows = ((offset + spread * values.clip(-3, 3) / 3) / (offset + spread) * scale).astype(np.float32)
    found = filled(layout, rows, seed)
    assert found.sketch is not None
    for query in (rows[0], -rows[1], rows[2] * np.float32(1e-3)):
        assert rank(found, query, 9) == by_comparing_all(found, query, 9)


@pytest.mark.parametrize("power", [1, 2])
def test_blocks_of_very_different_size_rank_as_comparing_all_does(power: int) -> None:
    layout = single_layout(power, (5, 5, 5))
    sizes = np.repeat([1e-40, 1.0, 1e38], 5)
    rows = (np.random.default_rng(0).normal(size=(300, 15)).clip(-3, 3) * sizes).astype(np.float32)
    rows[:150, 10:] = rows[0, 10:]  # so that for many the largest block does not decide
    rows[:70, 5:] = rows[0, 5:]
    found = filled(layout, rows)
    for query in (rows[0], rows[100], rows[200]):
        for limit in (5, 60, 100, 200):
            assert rank(found, query, limit) == by_comparing_all(found, query, limit)


@pytest.mark.parametrize("exponent", [-19.0, -20.0, -21.0, -21.5, -22.0, -22.3, -22.5])
def test_blocks_that_single_precision_hardly_holds_beside_others_still_rank_rightly(exponent: float) -> None:
    layout = single_layout(2, (5, 5), (1.0, 1.0))
    sizes = np.repeat([10.0**exponent, 1.0], 5)
    rows = (np.random.default_rng(0).normal(size=(300, 10)).clip(-3, 3) * sizes).astype(np.float32)
    rows[:200, 5:] = rows[0, 5:]  # so that for most the larger block does not decide
    found = filled(layout, rows)
    for query in rows[:200:20]:
        assert rank(found, query, 20) == by_comparing_all(found, query, 20)


@pytest.mark.parametrize("layout", LAYOUTS)
def test_equal_rows_are_ordered_by_id(layout: Layout) -> None:
    rows = np.repeat(random_rows(layout, 1), 1000, axis=0)
    found = filled(layout, rows)
    assert found.sketch is not None
    expected = [(f"{number:05}", 0.0) for number in range(5)]
    assert rank(found, rows[0], 5) == expected


@pytest.mark.parametrize("limit", [0, 1, 59, 60, 61, 10_000])
def test_any_limit_is_kept(limit: int) -> None:
    found = filled(LAYOUTS[0], random_rows(LAYOUTS[0], 60))
    answer = rank(found, random_rows(LAYOUTS[0], 1, 1)[0], limit)
    assert len(answer) == min(limit, 60)


def test_nothing_is_found_in_an_empty_or_wholly_excluded_library() -> None:
    layout = single_layout(1, (1,))
    query = np.zeros(1, np.float32)
    assert rank(Vectors(layout), query, 5) == []
    few = filled(layout, np.ones((2, 1), np.float32))
    assert rank(few, query, 5, exclude=["00000", "00001", "c"]) == []
    many = filled(layout, np.ones((30, 1), np.float32))
    assert rank(many, query, 5, exclude=list(many.ids)) == []
    many.remove(list(many.ids))
    assert rank(many, query, 5) == []


def test_of_a_clustered_library_few_rows_are_compared_exactly(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sketch, "BOX", 64)
    monkeypatch.setattr(candidates, "BOX", 64)
    monkeypatch.setattr(candidates, "LIKELY", 8)
    monkeypatch.setattr(sketch, "COARSE", 16)
    monkeypatch.setattr(sketch, "FINE", 32)
    layout = byte_layout(1, (16, 60, 20))
    rows = clustered_rows(layout, 20_000, 200)
    found = filled(layout, rows)
    compared: list[int] = []

    def counted(rows: RowArray, positions: PositionArray, *told: Any) -> DoubleArray:
        compared.append(len(positions))
        return distances(rows, positions, *told)

    monkeypatch.setattr(ranking, "distances", counted)
    for query in rows[::2000]:
        compared.clear()
        assert rank(found, query, 10) == by_comparing_all(found, query, 10)
        assert sum(compared) < 0.05 * len(rows)
