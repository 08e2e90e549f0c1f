import io

import pytest
from rich.console import Console
from rich.text import Text

from service.evaluation.outcome import Outcome
from service.evaluation.protocol import TRANSFORMATIONS
from service.evaluation.scores import score
from service.evaluation.tables import best_of, methods_table, outcome_tables, strengths_table
from tests.outcomes import outcome

NAMES = ("fused", "chks", "hks", "diffusion", "colour-diffusion", "colour-histogram", "meshhog")
KINDS = [(row, strength) for row in TRANSFORMATIONS for strength in range(1, 6)]


def printed(found: Outcome, width: int) -> list[str]:
    console = Console(width=width, file=io.StringIO(), record=True)
    for table in outcome_tables(found, width):
        console.print(table)
    return console.export_text().splitlines()


@pytest.mark.parametrize("n_methods", [1, 7, 16])
@pytest.mark.parametrize("width", [80, 120])
def test_every_method_fits_the_terminal_uncut(width: int, n_methods: int) -> None:
    names = (NAMES * 3)[:n_methods]
    ranks = {f"{name}-{k}" if k >= 7 else name: [1] * len(KINDS) for k, name in enumerate(names)}
    lines = printed(outcome(ranks, KINDS), width)
    assert max(map(len, lines)) <= width
    assert not any("…" in line for line in lines)
    assert sum("isometry+topology" in line for line in lines) >= n_methods + 1


def test_the_best_of_a_row_is_bold_and_the_paper_is_dim() -> None:
    found = outcome({"fused": [1, 1, 1, 1], "chks": [2, 2, 2, 2]})
    table = methods_table(found, score(found), ["fused", "chks"])
    fused, chks = (list(column.cells) for column in table.columns[1:])
    assert isinstance(fused[2], Text)
    assert isinstance(chks[2], Text)
    assert (fused[2].plain, str(fused[2].style)) == ("100.0", "bold")
    assert (chks[2].plain, str(chks[2].style)) == ("50.0  67", "")
    assert [str(span.style) for span in chks[2].spans] == ["dim not bold"]


def test_only_the_test_of_the_paper_stands_beside_its_figures() -> None:
    found = outcome({"chks": [1, 1, 1, 1]}, test="twins")
    table = methods_table(found, score(found), ["chks"])
    assert table.caption is None
    assert [str(cell) for cell in table.columns[1].cells][:3] == ["100.0"] * 3


def test_a_row_for_each_transformation_and_a_column_for_each_limit_of_strength() -> None:
    found = outcome({"chks": [1, 2, 4, 2]})
    table = strengths_table(found, "chks", score(found)["chks"])
    columns = [[str(cell) for cell in column.cells] for column in table.columns]
    assert columns[0] == ["all", "hue", "partiality"]
    assert [column[2] for column in columns[1:]] == ["–", "25.0", "25.0", "37.5", "37.5"]  # noqa: RUF001 - the dash
    assert [str(column.header) for column in table.columns[1:]] == ["1", "≤2", "≤3", "≤4", "≤5"]


def test_equal_numbers_have_no_best() -> None:
    assert best_of(["9.0", "10.0", "–"]) == "10.0"  # noqa: RUF001 - the dash
    assert best_of(["10.0", "10.0"]) is None
    assert best_of([]) is None


def test_names_are_no_markup() -> None:
    lines = printed(outcome({"[red]x": [1, 1, 1, 1]}, title="[bold]y[/]"), 80)
    assert any("[red]x" in line for line in lines)
    assert any("[bold]y[/]" in line for line in lines)
