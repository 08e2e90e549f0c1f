from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from index.arrays import RowArray
from index.distances import distances, levels_of
from index.layout import Layout
from index.methods import with_weights
from tests.layouts import PACKED, byte_layout, exact_distance, random_rows, single_layout

lengths = st.lists(st.integers(1, 70), min_size=1, max_size=3)
seeds = st.integers(0, 2**32 - 1)
powers = st.sampled_from([1, 2])


def of_all(layout: Layout, rows: RowArray, query: RowArray) -> list[float]:
    found: list[float] = distances(rows, np.arange(len(rows)), query, layout, layout.method).tolist()
    return found


def in_whole_numbers(layout: Layout, row: RowArray, query: RowArray) -> float:
    total = 0.0
    places = list(pairwise(layout.edges.tolist()))
    for name, weight, (start, end) in zip(PACKED, layout.weights(layout.method), places, strict=False):
        degree = 1 if name == "colour-curves" else 2
        pairs = zip(row[start:end].tolist(), query[start:end].tolist(), strict=True)
        gap = float(sum(abs(x**degree - y**degree) for x, y in pairs))
        total += float(weight) * (gap if layout.method.power == 1 else gap * gap)
    return total


@given(lengths=lengths, power=powers, seed=seeds)
def test_bytes_are_compared_as_whole_numbers_bit_for_bit(lengths: list[int], power: int, seed: int) -> None:
    layout = byte_layout(power, lengths)
    rows = random_rows(layout, 5, seed)
    rows[1], rows[2] = 0, 255
    for query in rows:
        assert of_all(layout, rows, query) == [in_whole_numbers(layout, row, query) for row in rows]


def test_the_widest_blocks_of_bytes_do_not_overflow() -> None:
    layout = byte_layout(1, (33_000,), [1.0])
    rows = np.repeat(np.array([[0], [255]], np.uint8), 33_000, axis=1)
    assert of_all(layout, rows, rows[1]) == [pytest.approx(33_000.0, rel=1e-12), 0.0]


@given(lengths=lengths, power=powers, seed=seeds, exponent=st.integers(-44, 38))
def test_single_numbers_are_compared_to_the_last_bits_of_double_precision(
    lengths: list[int], power: int, seed: int, exponent: int
) -> None:
    layout = single_layout(power, lengths)
    numbers = np.random.default_rng(seed).uniform(-1, 1, (3, layout.width))
    rows = (numbers * 10.0**exponent).astype(np.float32)
    exact = [float(exact_distance(layout, row, rows[0])) for row in rows]
    np.testing.assert_allclose(of_all(layout, rows, rows[0]), exact, rtol=1e-14, atol=0)


@pytest.mark.parametrize("layout", [byte_layout(1, (64, 300, 99)), single_layout(2, (64, 301, 100))])
def test_a_rows_distance_does_not_depend_on_the_rows_beside_it(layout: Layout) -> None:
    rows = random_rows(layout, 300)
    together = of_all(layout, rows, rows[0])
    assert together == [of_all(layout, row[None], rows[0])[0] for row in rows]
    some = np.random.default_rng(1).permutation(300)[:77]
    apart = distances(rows, some, rows[0], layout, layout.method)
    assert apart.tolist() == [together[place] for place in some]
    assert together == [of_all(layout, rows[:1], row)[0] for row in rows]  # symmetric, bit for bit


def test_own_weights_weigh_the_powers_of_the_blocks_distances() -> None:
    layout = single_layout(2, (1, 2), (0.25, 4.0))
    rows = np.array([[3, 2, -1], [0, 1, 1]], np.float32)  # from the query: 2 and 2, 1 and 1
    query = np.array([1, 1, 0], np.float32)
    assert of_all(layout, rows, query) == [17.0, 4.25]
    own = with_weights(layout.method, {"b1": 0.0})
    assert distances(rows, np.array([1, 0]), query, layout, own).tolist() == [0.25, 1.0]


def test_levels_are_what_bytes_stand_for_in_whole_units() -> None:
    layout = byte_layout(1, (1, 1, 1))
    assert levels_of(np.array([[255, 3, 200]], np.uint8), layout).tolist() == [[65025.0, 9.0, 200.0]]
    single = np.array([[0.1, -3.0]], np.float32)
    assert levels_of(single, single_layout(1, (2,))).tolist() == single.tolist()
