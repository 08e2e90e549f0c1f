"""`make bench`: each table has its place, is written as soon as it is measured, and is drawn."""

import re
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import pytest

from benchmarks.bench import DOCS, TABLES, TINY, write
from benchmarks.measured import Measured, machine, processor, read_measured
from benchmarks.pages import Row, places_of
from benchmarks.speed_plot import further, number, speed_plot

PAGE = "a\n<!-- table search-sizes -->\nold\n<!-- end -->\nb\n<!-- table http -->\nkept\n<!-- end -->\n"
SEARCHES = [
    {"method": name, "rows": rows, "one read, ms": read, "query, ms": query}
    for name in ("chks", "fused")
    for rows, read, query in (("1,000", "0.02", "0.3"), ("10,000", "0.2", "0.6"))
]
EIGEN = [{"what": "four η", "vertices": n, "ours, s": s} for n, s in (("2,000", "0.1"), ("5,000", "0.2"))]
JOBS = [{"what": what, "vertices": "10,000", "seconds": "0.9"} for what in ("OBJ", "PLY")]


def columns(rows: list[Row]) -> set[str]:
    assert len({tuple(row) for row in rows}) == 1
    return set(rows[0])


def test_the_page_has_a_place_for_every_table() -> None:
    assert places_of((DOCS / "speed.md").read_text(encoding="utf-8")) == list(TABLES)


def test_a_table_is_written_alone_with_the_machine(tmp_path: Path) -> None:
    (tmp_path / "speed.md").write_text(PAGE, encoding="utf-8")
    write(tmp_path, "search-sizes", SEARCHES)
    page = (tmp_path / "speed.md").read_text(encoding="utf-8")
    assert "| chks | 1,000 | 0.02 | 0.3 |\n" in page
    assert processor() in page
    assert "old" not in page
    assert page.endswith("<!-- table http -->\nkept\n<!-- end -->\n")


def test_what_was_measured_before_is_kept(tmp_path: Path) -> None:
    (tmp_path / "speed.md").write_text(PAGE, encoding="utf-8")
    write(tmp_path, "search-sizes", SEARCHES)
    write(tmp_path, "eigen-sizes", EIGEN)
    kept = read_measured(tmp_path / "speed.json")
    assert kept["search-sizes"]["rows"] == SEARCHES
    assert (tmp_path / "speed.svg").read_text(encoding="utf-8") == speed_plot(kept)


def test_the_machine_is_a_processor_a_count_a_version_and_a_day() -> None:
    assert re.fullmatch(r".+, \d+ cores, Python 3\.\d+\.\S+, \d{4}-\d\d-\d\d\.", machine())


def test_pairs_are_counted_of_made_shapes_and_none_is_missing() -> None:
    rows = list(TABLES["pairs"](replace(TINY, counted=1)))
    assert columns(rows) == {"shapes", "described", "spectra", "pairs", "spectra with more or fewer"}
    assert [(row["described"], row["spectra with more or fewer"]) for row in rows] == [("1", "0")]


def test_no_data_no_rows_of_cores() -> None:
    assert list(TABLES["cores"](TINY)) == []


def test_the_same_numbers_give_the_same_drawing_and_no_numbers_an_empty_one() -> None:
    measured: Measured = {
        "search-sizes": {"rows": SEARCHES},
        "eigen-sizes": {"rows": EIGEN},
        "job-sizes": {"rows": JOBS},
    }
    drawn = speed_plot(measured)
    assert drawn == speed_plot(measured)
    assert "extrapolated, not measured" in drawn
    assert all(row["what"] in drawn for row in JOBS)
    assert "metadata" not in drawn
    assert ElementTree.fromstring(speed_plot({})).tag.endswith("svg")  # noqa: S314 - our own


def test_a_power_law_is_continued() -> None:
    size, time = further(([10.0, 100.0, 1_000.0], [9.0, 2.0, 6.0]))
    assert size == 10_000.0
    assert time == pytest.approx(18.0)
    assert number("1,234.5") == 1234.5
