"""A page keeps its text, and the tables that were not measured again."""

from pathlib import Path

from benchmarks.pages import fill, fill_page, places_of, table_of

PAGE = "a\n<!-- table one -->\nold\n<!-- end -->\nb\n<!-- table two -->\nkept\n<!-- end -->\nc <!-- end -->\n"
TABLE = table_of([{"what": "x", "s": "1.5"}])


def test_a_table_takes_its_place_and_all_else_stays() -> None:
    assert fill(PAGE, {"one": TABLE}) == PAGE.replace("old\n", TABLE)


def test_a_page_without_new_results_stays_as_it_is() -> None:
    assert fill(PAGE, {}) == fill(PAGE, {"three": TABLE}) == PAGE


def test_a_table_can_be_replaced_again() -> None:
    assert fill(fill(PAGE, {"one": "x\n"}), {"one": TABLE}) == fill(PAGE, {"one": TABLE})


def test_what_a_table_holds_is_taken_as_it_is() -> None:
    assert "\\1 \\g<2>\n" in fill(PAGE, {"two": "\\1 \\g<2>\n"})


def test_places_are_named_in_their_order() -> None:
    assert places_of(PAGE) == ["one", "two"]
    assert places_of(fill(PAGE, {"one": "", "two": ""})) == ["one", "two"]


def test_numbers_stand_on_the_right_and_text_on_the_left() -> None:
    rows = [{"what": "x", "s": "1.5", "of": "2"}, {"what": "3 y", "s": "12.0", "of": "-"}]
    assert table_of(rows) == "| what | s | of |\n| --- | --: | --- |\n| x | 1.5 | 2 |\n| 3 y | 12.0 | - |\n"


def test_a_file_is_filled(tmp_path: Path) -> None:
    (tmp_path / "page.md").write_text(PAGE, encoding="utf-8")
    fill_page(tmp_path / "page.md", {"two": "é\n"})
    assert (tmp_path / "page.md").read_text(encoding="utf-8") == PAGE.replace("kept", "é")
