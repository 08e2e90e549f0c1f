"""The page of errors is the one that the program makes."""

from pathlib import Path

from service.http.error_page import error_page
from service.http.meanings import MEANINGS

PAGE = Path(__file__).parents[1] / "docs" / "errors.md"


def test_the_page_is_up_to_date() -> None:
    assert PAGE.read_text(encoding="utf-8") == error_page()


def test_every_code_stands_in_it_once() -> None:
    lines = error_page().splitlines()
    for code in MEANINGS:
        assert sum(line.startswith(f"| `{code}` |") for line in lines) == 1, code
