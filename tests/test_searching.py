"""The rows of the tables of searches: their columns, and that what they time answers as brute force does."""

from collections.abc import Sequence

import numpy as np
import pytest

from benchmarks.made_rows import Blocks, make_rows
from benchmarks.searching import CHECKED, NAMES, digits, read_all, search_rows, size_rows
from index.arrays import SingleArray
from index.methods import METHODS
from index.packing import PACKINGS
from index.vectors import SKETCHED

LENGTHS = {"log-hks": 6, "colour-histogram": 20, "colour-curves": 9, "hks-0": 5, "hks-0.05": 5, "hks-0.1": 5}
RATIOS = ("median / read", "95 % / read", "comparing all / read", "sketch / rows", "all memory / rows")


def block(name: str, random: np.random.Generator) -> SingleArray:
    """Return shares, or numbers with a sign where the block has them."""
    if name in PACKINGS and not PACKINGS[name].squared:
        return random.standard_normal(LENGTHS[name]).astype(np.float32)
    return random.dirichlet(np.ones(LENGTHS[name])).astype(np.float32)


def random_blocks(count: int) -> Sequence[Blocks]:
    random = np.random.default_rng(7)
    return [{name: block(name, random) for name in LENGTHS} for _ in range(count)]


@pytest.mark.parametrize("n_rows", [2_000, SKETCHED])
def test_what_is_timed_answers_as_brute_force_does(n_rows: int) -> None:
    rows = list(search_rows(random_blocks(5), n_rows))
    assert [row["method"] for row in rows] == list(NAMES)
    for row in rows:
        assert row["wrong answers"] == f"0 of {CHECKED}"
        assert row["rows"].startswith(f"{n_rows:,} x ")
        assert all(float(row[column]) >= 0.0 for column in RATIOS)
        assert (float(row["sketch / rows"]) > 0.0) == (n_rows >= SKETCHED)


def test_there_is_a_row_for_each_method_and_size() -> None:
    rows = list(size_rows(random_blocks(4), (50, 200)))
    assert [(row["method"], row["rows"]) for row in rows] == [(n, s) for n in NAMES for s in ("50", "200")]
    assert {tuple(row) for row in rows} == {("method", "rows", "one read, ms", "query, ms", "95 %, ms")}


@pytest.mark.parametrize("name", NAMES)
def test_one_read_reads_every_byte(name: str) -> None:
    rows = make_rows(random_blocks(3), METHODS[name], 512, 1).rows  # a whole number of lanes
    words = rows.reshape(-1).view(np.uint64)
    assert read_all(rows) % 2**64 == int(words.sum(dtype=np.uint64))


@pytest.mark.parametrize("name", NAMES)
def test_no_two_rows_are_equal(name: str) -> None:
    rows = make_rows(random_blocks(3), METHODS[name], 300, 1).rows
    assert len(np.unique(rows, axis=0)) == len(rows)


@pytest.mark.parametrize(("value", "shown"), [(0.01234, "0.0123"), (12.34, "12.3"), (1234.5, "1234")])
def test_numbers_are_shown_by_three_digits(value: float, shown: str) -> None:
    assert digits(value) == shown
