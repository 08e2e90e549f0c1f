"""The page of promises names tests and parts that exist, and shows what was found last."""

from pathlib import Path

from soak.parts import PARTS
from soak.promises_page import PAGE, PROMISES, read_kept, table

TESTS = Path(__file__).parent
FOUND: dict[str, dict[str, str | int]] = {
    "kills": {"figures": "9 kills", "broken": 1, "seed": 3, "day": "2026-01-02"}
}


def test_every_test_that_is_named_exists() -> None:
    named = {name for promise in PROMISES for name in promise.tests}
    assert [name for name in sorted(named) if not (TESTS / f"{name}.py").is_file()] == []


def test_every_part_of_the_soak_proves_a_promise() -> None:
    assert {part for promise in PROMISES for part in promise.parts} == PARTS.keys()


def test_a_row_shows_what_its_parts_found_and_how_much_was_broken() -> None:
    row = next(line for line in table(FOUND).splitlines() if "kill -9" in line)
    assert "9 kills; **1 broken** (2026-01-02)" in row


def test_what_was_not_tried_is_not_shown_as_kept() -> None:
    assert all(line.endswith("| - |") for line in table({}).splitlines()[2:])


def test_the_page_shows_what_is_kept() -> None:
    assert table(read_kept()) in PAGE.read_text(encoding="utf-8")
