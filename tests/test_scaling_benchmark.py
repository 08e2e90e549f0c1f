from benchmarks.pages import places_of
from benchmarks.scaling import PAGE
from benchmarks.scaling_arithmetic import SIZES, arithmetic, count_of, size_of
from benchmarks.vector_tables import recall


def test_sizes_are_told_in_the_unit_that_fits_to_two_digits() -> None:
    assert [size_of(n) for n in (1.234e6, 7.5e9, 7.46e13)] == ["1.2 MB", "7.5 GB", "75 TB"]
    assert [count_of(n) for n in (0.123, 38_888, 2_340_000)] == ["0.12", "39,000", "2.3 million"]


def test_every_row_has_a_cell_for_every_size() -> None:
    rows = list(arithmetic())
    assert {len(row) for row in rows} == {1 + len(SIZES)}
    told = {row[""]: list(row.values())[1:] for row in rows}
    assert told["describing, core-hours"][-1] == "28,000 to 39,000"


def test_a_result_as_near_as_the_last_true_one_counts_as_found() -> None:
    true = [("a", 0.0), ("b", 1.0)]
    assert recall([[("a", 0.0), ("c", 1.0)]], [true]) == 1.0
    assert recall([[("a", 0.0), ("d", 2.0)]], [true]) == 0.5


def test_the_page_has_a_place_for_each_table() -> None:
    assert places_of(PAGE.read_text(encoding="utf-8")) == ["queries", "room", "same", "arithmetic"]
