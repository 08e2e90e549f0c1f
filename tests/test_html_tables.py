import re

from service.evaluation.html_tables import methods_table, overview_table, strengths_table
from service.evaluation.scores import score
from tests.outcomes import outcome


def rows(html: str) -> dict[str, list[str]]:
    """Return the cells of each row as text, by its name."""
    found = re.findall(r'<th scope="row">(.*?)</th>(.*?)</tr>', html)
    return {
        re.sub("<.*?>", "", name): [plain(cell) for cell in cells.split("</td>")[:-1]]
        for name, cells in found
    }


def plain(cell: str) -> str:
    return re.sub("<(?!/?b>).*?>", "", cell)


def test_the_best_is_bold_and_the_figures_of_the_paper_stand_beside() -> None:
    found = outcome({"fused": [1, 1, 1, 1], "chks": [2, 2, 2, 2]})
    table = rows(methods_table(found, score(found)))
    assert table["partiality"] == ["<b>100.0</b>", "50.0 67"]
    assert table["hue"] == ["<b>100.0</b>", "50.0 –"]  # noqa: RUF001 - the dash of what is not known
    assert table["right at once"] == ["<b>100.0</b>", "0.0 "]
    assert list(table)[:3] == ["all", "hue", "partiality"]


def test_strengths_that_were_not_asked_have_a_dash() -> None:
    found = outcome({"chks": [1, 2, 4, 2]})
    table = rows(strengths_table(found, "chks", score(found)["chks"]))
    assert table["partiality"] == ["–", "25.0", "25.0", "37.5", "37.5"]  # noqa: RUF001 - the dash


def test_the_overview_has_a_row_for_each_test_and_dashes_for_methods_it_lacks() -> None:
    first = outcome({"fused": [1, 1, 1, 1], "chks": [2, 2, 2, 2]}, title="First")
    second = outcome({"fused": [2, 2, 2, 2]}, test="twins", title="Second")
    table = rows(overview_table([first, second], [score(first), score(second)]))
    assert table == {
        "First": ["4", "8", "<b>100.0</b>", "50.0"],
        "Second": ["4", "8", "50.0", "–"],  # noqa: RUF001 - the dash
    }


def test_names_are_escaped() -> None:
    found = outcome({"<i>": [1, 1, 1, 1]}, title="a < b & c")
    assert "<i>" not in methods_table(found, score(found))
    assert "a &lt; b &amp; c" in overview_table([found], [score(found)])
