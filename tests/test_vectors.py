from collections.abc import Iterator

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from index import sketch, vectors
from index.arrays import RowArray
from index.distances import levels_of
from index.layout import Layout
from index.vectors import GONE, Vectors
from tests.layouts import byte_layout, random_rows, single_layout

LAYOUT = single_layout(1, (2, 3))
BYTES = byte_layout(1, (3, 4, 2))


@pytest.fixture(autouse=True, scope="module")
def small() -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(vectors, "SKETCHED", 10)
        patch.setattr(vectors, "PIECE", 4)
        patch.setattr(sketch, "BOX", 4)
        yield


def filled(layout: Layout, n_rows: int) -> Vectors:
    made = Vectors(layout)
    made.put([f"s{number}" for number in range(n_rows)], random_rows(layout, n_rows))
    return made


def as_dictionary(found: Vectors) -> dict[str, bytes]:
    return {found.ids[position]: found.rows[position].tobytes() for position in found.here}


def as_told(ids: list[str], rows: RowArray) -> dict[str, bytes]:
    return {shape_id: row.tobytes() for shape_id, row in zip(ids, rows, strict=True)}


actions = st.sampled_from(["put", "remove", "settle", "restore"])
steps = st.lists(st.tuples(actions, st.sets(st.integers(0, 30), max_size=25)), max_size=12)


@given(steps=steps, layout=st.sampled_from([LAYOUT, BYTES]))
@settings(max_examples=200)
def test_after_any_changes_the_vectors_are_those_of_a_dictionary(
    steps: list[tuple[str, set[int]]], layout: Layout
) -> None:
    found = Vectors(layout)
    expected: dict[str, bytes] = {}
    for seed, (action, numbers) in enumerate(steps):
        ids = [f"s{number}" for number in sorted(numbers)]
        if action == "put":
            rows = random_rows(layout, len(ids), seed)
            found.put(ids, rows)
            expected.update(as_told(ids, rows))
        elif action == "remove":
            found.remove(ids)
            expected = {shape_id: row for shape_id, row in expected.items() if shape_id not in ids}
        elif action == "settle":
            found.settle()
        else:
            copies = {name: array.copy() for name, array in found.arrays().items()}
            found = Vectors.restored(layout, list(found.ids), copies)
        assert as_dictionary(found) == expected
        assert len(found) == len(expected)
        assert found.sketch is None or found.sketch.size == len(found.ids)
    for shape_id in expected:
        assert found.ids[int(found.positions([shape_id])[0])] == shape_id


def test_few_rows_have_no_sketch_and_many_have_one_once_settled() -> None:
    few, many = filled(LAYOUT, 9), filled(LAYOUT, 10)
    for each in (few, many):
        assert each.sketch is None
        each.settle()
    assert few.sketch is None
    assert many.sketch is not None
    assert set(few.arrays()) == {"rows", "largest", "ordered"}


def test_the_order_is_made_anew_when_a_quarter_is_stale_and_not_before() -> None:
    found = filled(LAYOUT, 40)
    found.settle()
    first = found.sketch
    found.put([f"t{number}" for number in range(5)], random_rows(LAYOUT, 5, 1))
    found.remove([f"s{number}" for number in range(5)])
    found.settle()  # 5 out of order and 5 removed, of 40
    assert found.sketch is first
    assert len(found.ids) == 45
    found.remove(["s5"])
    found.settle()
    assert found.sketch is not first
    assert len(found.ids) == len(found) == 39
    assert GONE not in found.ids


def test_removed_rows_keep_their_place_without_an_id() -> None:
    found = filled(LAYOUT, 3)
    found.remove(["s1"])
    assert list(found.ids) == ["s0", GONE, "s2"]
    assert found.here.tolist() == [0, 2]
    assert found.only_here(np.array([2, 1, 0])).tolist() == [2, 0]


@pytest.mark.parametrize("layout", [LAYOUT, BYTES])
def test_the_largest_norm_is_that_of_any_row_so_far(layout: Layout) -> None:
    found = Vectors(layout)
    most = 0.0
    for seed in range(3):
        rows = random_rows(layout, 9, seed)
        found.put([f"{seed}-{number}" for number in range(9)], rows)
        most = max(most, float(np.abs(levels_of(rows, layout)).sum(axis=1).max()))
        assert found.largest == most
    again = Vectors.restored(layout, list(found.ids), {**found.arrays(), "rows": found.rows.copy()})
    assert again.largest == most


def test_unknown_ids_are_nowhere_and_their_removal_changes_nothing() -> None:
    found = filled(LAYOUT, 1)
    found.remove(["b", GONE])
    assert found.positions(["b", "s0", "s0", GONE]).tolist() == [0]
    assert len(found) == 1


def test_rows_that_change_again_and_again_take_no_more_room() -> None:
    found = Vectors(LAYOUT)
    for seed in range(50):
        found.put(["a", "b"], random_rows(LAYOUT, 2, seed))
        found.settle()
    assert len(found.ids) <= 4
    assert len(found) == 2
