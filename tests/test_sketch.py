from collections.abc import Iterator, Sequence
from itertools import accumulate, pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from index import candidates as candidates_module
from index import sketch as sketch_module
from index.arrays import DoubleArray, RowArray
from index.candidates import MARGIN, Candidates
from index.distances import distances, levels_of
from index.layout import Layout
from index.methods import Method, with_weights
from index.sketch import Sketch
from tests.layouts import byte_layout, clustered_rows, random_rows, single_layout

BOX = 4
LAYOUTS = [
    byte_layout(1, (3, 9, 5)),
    byte_layout(2, (4, 6)),
    single_layout(1, (6, 8)),
    single_layout(2, (9, 5)),
]
seeds = st.integers(0, 2**32 - 1)


@pytest.fixture(autouse=True, scope="module")
def small() -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sketch_module, "BOX", BOX)
        patch.setattr(candidates_module, "BOX", BOX)
        patch.setattr(candidates_module, "LIKELY", 3)
        patch.setattr(sketch_module, "COARSE", 4)
        patch.setattr(sketch_module, "FINE", 7)
        patch.setattr(sketch_module, "MERGED", 2)
        yield


def grown(layout: Layout, seed: int, sizes: Sequence[int]) -> tuple[Sketch, RowArray]:
    """Return a sketch of rows that came piece by piece, and the rows by position."""
    rows = clustered_rows(layout, sum(sizes), 4, seed)
    edges = [0, *accumulate(sizes)]
    sketch, order = Sketch.learn(rows[: edges[1]], layout)
    for start, end in pairwise(edges[1:]):
        sketch.append(rows[start:end])
    return sketch, np.concatenate([rows[order], rows[edges[1] :]])


def exact(layout: Layout, rows: RowArray, query: RowArray, method: Method | None = None) -> DoubleArray:
    return distances(rows, np.arange(len(rows)), query, layout, method or layout.method)


def largest(layout: Layout, rows: RowArray) -> float:
    return float(np.abs(levels_of(rows, layout)).sum(axis=1).max())


@given(
    layout=st.sampled_from(LAYOUTS),
    seed=seeds,
    sizes=st.lists(st.integers(1, 60), min_size=1, max_size=5),
    share=st.floats(0, 1),
    own=st.sampled_from([None, 0.0, 5.0]),
)
@settings(max_examples=200)
def test_no_row_within_a_distance_is_ruled_out_and_no_bound_exceeds_one(
    layout: Layout, seed: int, sizes: list[int], share: float, own: float | None
) -> None:
    sketch, rows = grown(layout, seed, sizes)
    method = (
        layout.method if own is None else with_weights(layout.method, {layout.method.blocks[0].name: own})
    )
    for query in (rows[-1], random_rows(layout, 1, seed)[0]):
        found = exact(layout, rows, query, method)
        limit = float(np.quantile(found, share))
        candidates = Candidates(sketch, query, method, largest(layout, rows))
        candidates.by_centres(5)
        candidates.by_rows(limit, 5)
        positions, bounds = candidates.within(limit)
        assert set(np.flatnonzero(found <= limit)) <= set(positions.tolist())
        assert (np.diff(positions) > 0).all()
        assert (bounds <= found[positions] * (1 + MARGIN)).all()


@given(
    layout=st.sampled_from(LAYOUTS), seed=seeds, sizes=st.lists(st.integers(1, 40), min_size=1, max_size=9)
)
def test_rows_that_come_later_are_kept_as_those_that_were_learnt(
    layout: Layout, seed: int, sizes: list[int]
) -> None:
    sketch, rows = grown(layout, seed, sizes)
    assert sketch.size == len(rows)
    codes = sketch.coarse.codes(rows)
    boxed = sketch.boxes.transpose(0, 2, 1).reshape(-1, codes.shape[1])
    np.testing.assert_array_equal(boxed[: len(rows)], codes)
    np.testing.assert_array_equal(sketch.codes[: len(rows)], sketch.fine.codes(rows))
    for box, start in enumerate(range(0, len(rows), BOX)):
        np.testing.assert_array_equal(sketch.lows[:, box], codes[start : start + BOX].min(axis=0))
        np.testing.assert_array_equal(sketch.highs[:, box], codes[start : start + BOX].max(axis=0))


def test_room_grows_by_a_share_and_not_row_by_row() -> None:
    sketch, rows = grown(LAYOUTS[0], 0, [400])
    rooms = []
    for row in rows[:200]:
        sketch.append(row[None])
        rooms.append(len(sketch.boxes))
    assert sketch.size == 600
    assert len(set(rooms)) < 8  # of the 50 boxes that were added


def test_the_order_is_a_permutation_and_makes_boxes_small() -> None:
    layout = LAYOUTS[0]
    rows = clustered_rows(layout, 400, 20)
    sketch, order = Sketch.learn(rows, layout)
    np.testing.assert_array_equal(np.sort(order), np.arange(400))
    as_they_came = Sketch.empty(sketch.coarse, sketch.fine)
    as_they_came.append(rows)
    sizes = [(each.highs.astype(int) - each.lows).sum() for each in (sketch, as_they_came)]
    assert sizes[0] < 0.5 * sizes[1]


@given(layout=st.sampled_from(LAYOUTS), seed=seeds, count=st.integers(1, 40))
def test_likely_rows_are_distinct_and_as_many_as_are_asked_for_at_most(
    layout: Layout, seed: int, count: int
) -> None:
    sketch, rows = grown(layout, seed, [70, 5])
    candidates = Candidates(sketch, rows[0], layout.method, largest(layout, rows))
    for positions in (candidates.by_centres(count), candidates.by_rows(np.inf, count)):
        assert 0 < len(set(positions.tolist())) == len(positions) <= count
        assert positions.max() < 75


@pytest.mark.parametrize("layout", LAYOUTS)
def test_likely_rows_are_much_nearer_than_others(layout: Layout) -> None:
    sketch, rows = grown(layout, 0, [300])
    for query in rows[::30]:
        found = exact(layout, rows, query)
        candidates = Candidates(sketch, query, layout.method, largest(layout, rows))
        for positions in (candidates.by_centres(5), candidates.by_rows(np.inf, 5)):
            assert np.median(found[positions]) < 0.5 * np.median(found)


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_sketch_comes_back_from_its_arrays_and_goes_on(layout: Layout) -> None:
    sketch, _ = grown(layout, 0, [90, 7])
    copies = {name: array.copy() for name, array in sketch.arrays().items()}
    again = Sketch.restored(layout, copies)
    more = random_rows(layout, 20)
    for each in (sketch, again):
        each.append(more)
    one, other = sketch.arrays(), again.arrays()
    assert one.keys() == other.keys()
    for name in one:
        np.testing.assert_array_equal(one[name], other[name])
