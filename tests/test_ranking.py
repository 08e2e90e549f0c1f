from collections.abc import Collection
from fractions import Fraction

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from index.layout import Layout
from index.methods import Block, Method, with_weights
from index.ranking import Ranked, certain_radius, rank
from index.vectors import Vectors

Rows = npt.NDArray[np.float32]


def make_method(power: int, weights: Collection[float]) -> Method:
    blocks = tuple(Block(name=f"b{i}", weight=weight, power=power) for i, weight in enumerate(weights))
    return Method(name="m", blocks=blocks, description="")


def filled(layout: Layout, ids: list[str], rows: Rows) -> Vectors:
    vectors = Vectors(layout)
    vectors.put(ids, rows)
    return vectors


def brute_force(
    layout: Layout,
    ids: list[str],
    rows: Rows,
    query: Rows,
    limit: int,
    exclude: Collection[str] = (),
    method: Method | None = None,
) -> Ranked:
    """Compare with every row, in plain double precision, block by block and number by number."""
    answer = []
    for shape_id, row in zip(ids, rows, strict=True):
        total, start = 0.0, 0
        for block, length in zip((method or layout.method).blocks, layout.lengths, strict=True):
            gaps = [abs(float(row[i]) - float(query[i])) for i in range(start, start + length)]
            total += block.weight * sum(gaps) ** block.power
            start += length
        if shape_id not in exclude:
            answer.append((total, shape_id))
    return [(shape_id, distance) for distance, shape_id in sorted(answer)[:limit]]


@st.composite
def libraries(draw: st.DrawFn) -> tuple[Layout, list[str], Rows, Rows]:
    """Draw layouts, ids and rows of small multiples of 1/8: sums are exact, and many distances equal."""
    power = draw(st.sampled_from([1, 2]))
    lengths = tuple(draw(st.lists(st.integers(1, 4), min_size=1, max_size=3)))
    weight = st.sampled_from([1.0, 0.05, 0.1, 1 / 0.587, 1 / 150.5, 3.0])
    weights = [draw(weight) for _ in lengths]
    layout = Layout(method=make_method(power, weights), lengths=lengths)
    n_rows = draw(st.integers(1, 400))
    n_different = draw(st.integers(1, 12))
    generator = np.random.default_rng(draw(st.integers(0, 2**32)))
    different = generator.integers(-8, 9, (n_different, layout.width)).astype(np.float32) / np.float32(8)
    rows = different[generator.integers(0, n_different, n_rows)]
    ids = [f"{number:04}" for number in generator.permutation(n_rows)]
    query = generator.integers(-8, 9, layout.width).astype(np.float32) / np.float32(8)
    return layout, ids, rows, query


@given(library=libraries(), limit=st.integers(0, 420), seed=st.integers(0, 99))
@settings(max_examples=300)
def test_the_certified_answer_is_that_of_brute_force_ties_included(
    library: tuple[Layout, list[str], Rows, Rows], limit: int, seed: int
) -> None:
    layout, ids, rows, query = library
    generator = np.random.default_rng(seed)
    exclude = set(generator.choice([*ids, "unknown"], generator.integers(0, len(ids) + 1)))
    expected = brute_force(layout, ids, rows, query, limit, exclude)
    assert rank(filled(layout, ids, rows), query, limit, exclude) == expected


@given(library=libraries(), limit=st.integers(1, 50), data=st.data())
def test_own_weights_give_the_answer_of_brute_force(
    library: tuple[Layout, list[str], Rows, Rows], limit: int, data: st.DataObject
) -> None:
    layout, ids, rows, query = library
    weights = {block.name: data.draw(st.sampled_from([0.0, 0.5, 1.0, 7.0])) for block in layout.method.blocks}
    if not any(weights.values()):
        weights["b0"] = 1.0
    method = with_weights(layout.method, weights)
    expected = brute_force(layout, ids, rows, query, limit, method=method)
    assert rank(filled(layout, ids, rows), query, limit, method=method) == expected


@given(
    seed=st.integers(0, 2**32),
    power=st.sampled_from([1, 2]),
    scale=st.sampled_from([1e-42, 1e-30, 1e-3, 1.0, 1e10, 1e30, 3e38]),
    offset=st.sampled_from([0.0, 1.0]),
)
@settings(max_examples=120)
def test_numbers_of_any_size_rank_as_comparing_all_does(
    seed: int, power: int, scale: float, offset: float
) -> None:
    generator = np.random.default_rng(seed)
    layout = Layout(method=make_method(power, [1.7, 0.05, 0.3]), lengths=(7, 40, 19))
    spread = generator.choice([1.0, 1e-7])
    values = (offset + spread * generator.random((500, layout.width))) / (1 + offset) * scale
    rows = values.astype(np.float32)
    ids = [f"{number:03}" for number in range(500)]
    vectors = filled(layout, ids, rows)
    distances = layout.distances(vectors.rows(np.arange(500)), rows[0], layout.method)
    expected = sorted(zip(distances.tolist(), ids, strict=True))[:9]
    assert rank(vectors, rows[0], 9) == [(shape_id, distance) for distance, shape_id in expected]


def crossed() -> tuple[Layout, list[str], Rows, Rows]:
    """Return a library in which plain L1 finds the wrong shapes, as bad as the squares allow.

    From the origin, "spread" has 1 in each of three blocks: s = 3, d = 3. The decoys have 2.9 in
    one block alone: s = 2.9, d = 8.41. There are more decoys than candidates.
    """
    layout = Layout(method=make_method(2, [1.0, 1.0, 1.0]), lengths=(1, 1, 1))
    decoys = np.zeros((500, 3), dtype=np.float32)
    decoys[np.arange(500), np.arange(500) % 3] = 2.9
    rows = np.vstack([decoys, np.ones((2, 3), dtype=np.float32)])
    return (
        layout,
        [*(f"decoy {number:03}" for number in range(500)), "spread b", "spread a"],
        rows,
        np.zeros(3, dtype=np.float32),
    )


def test_wrong_candidates_are_noticed_and_the_search_goes_on(monkeypatch: pytest.MonkeyPatch) -> None:
    layout, ids, rows, query = crossed()
    vectors = filled(layout, ids, rows)
    candidates, _ = vectors.nearest(query, 40)
    assert not {500, 501} & set(candidates.tolist())  # plain L1 does not see them
    asked: list[float] = []
    within = Vectors.within

    def watched(self: Vectors, query: Rows, radius: float) -> npt.NDArray[np.int64]:
        asked.append(radius)
        return within(self, query, radius)

    monkeypatch.setattr(Vectors, "within", watched)
    assert rank(vectors, query, 2) == [("spread a", 3.0), ("spread b", 3.0)]
    assert len(asked) == 1


def test_clear_cases_are_certified_by_the_candidates_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    layout = Layout(method=make_method(1, [1 / 0.587, 1 / 1.87, 1 / 150.5]), lengths=(64, 1600, 144))
    rows = np.random.default_rng(0).random((2000, layout.width), dtype=np.float32)
    near = np.linspace(0, 0.05, 20, dtype=np.float32)[:, None]
    rows[:20] = rows[0] + near
    ids = [f"{number:04}" for number in range(2000)]
    vectors = filled(layout, ids, rows)

    def forbidden(*_: object) -> None:
        raise AssertionError("the candidates were enough")

    monkeypatch.setattr(Vectors, "within", forbidden)
    answer = rank(vectors, rows[0], 10)
    assert [shape_id for shape_id, _ in answer] == ids[:10]


def test_ties_across_the_border_of_the_candidates_are_ordered_by_id() -> None:
    layout = Layout(method=make_method(1, [1.0]), lengths=(2,))
    ids = [f"{number:04}" for number in range(3000)]
    ids.reverse()
    vectors = filled(layout, ids, np.ones((3000, 2), dtype=np.float32))
    answer = rank(vectors, np.zeros(2, dtype=np.float32), 5)
    assert answer == [(f"{number:04}", 2.0) for number in range(5)]


def test_the_radius_holds_in_exact_arithmetic() -> None:
    generator = np.random.default_rng(5)
    for power in (1, 2):
        layout = Layout(method=make_method(power, [0.05, 1 / 0.587, 0.3]), lengths=(5, 60, 30))
        rows = (100_000 + generator.random((300, layout.width))).astype(np.float32)
        vectors = filled(layout, [str(i) for i in range(300)], rows)
        query = rows[0]
        norms = float(np.abs(vectors.scaled(query)).sum()) + vectors.largest_norm
        positions, sums = vectors.nearest(query, 300)
        for position, s in zip(positions, sums, strict=True):
            exact = exact_distance(layout, rows[position], query)
            assert float(s) <= certain_radius(layout, float(exact), norms)


def exact_distance(layout: Layout, row: Rows, query: Rows) -> Fraction:
    total = Fraction(0)
    for block, place in zip(layout.method.blocks, layout.slices, strict=True):
        pairs = zip(row[place].tolist(), query[place].tolist(), strict=True)
        gap = sum((abs(Fraction(x) - Fraction(y)) for x, y in pairs), Fraction(0))
        total += Fraction(block.weight) * gap**block.power
    return total


def test_nothing_is_asked_of_an_empty_or_wholly_excluded_library() -> None:
    layout = Layout(method=make_method(1, [1.0]), lengths=(1,))
    query = np.zeros(1, dtype=np.float32)
    assert rank(Vectors(layout), query, 5) == []
    vectors = filled(layout, ["a", "b"], np.ones((2, 1), dtype=np.float32))
    assert rank(vectors, query, 5, exclude=["a", "b", "c"]) == []
    assert rank(vectors, query, 0) == rank(vectors, query, -1) == []
