"""The scores of a test as tables for a terminal, in the paper's layout."""

from collections.abc import Iterator, Mapping, Sequence

from rich import box
from rich.table import Table
from rich.text import Text

from service.evaluation.outcome import Outcome
from service.evaluation.paper import PAPER, published
from service.evaluation.scores import CUTOFFS, STRENGTHS, Scores, rows_of, score

UNKNOWN = "–"  # noqa: RUF001 - an en dash is how a table says that there is nothing
BETWEEN = 2  # blanks between columns


def outcome_tables(outcome: Outcome, width: int = 80) -> Iterator[Table]:
    """Yield the table of all methods, then one of every method by strength.

    Parameters
    ----------
    width : int
        Of the terminal in characters; where the methods do not fit beside each other, the table is cut.
    """
    scores = score(outcome)
    for shown in _fitting(outcome, list(scores), width):
        yield methods_table(outcome, scores, shown)
    for method in scores:
        yield strengths_table(outcome, method, scores[method])


def methods_table(outcome: Outcome, scores: Mapping[str, Scores], shown: Sequence[str]) -> Table:
    """Return mAP at strengths ≤ 5: a row for each transformation, a column for each method shown.

    The best of a row, among all methods, is bold; the paper's figure stands beside ours, dim.
    """
    table = _table(f"{outcome.title}\nmAP in %, {_size(outcome)}")
    for method in shown:
        table.add_column(heading(method), justify="right", no_wrap=True)
    for row in rows_of(outcome):
        values = {method: shown_value(scores[method].mean_precision[row][-1]) for method in scores}
        best = best_of(list(values.values()))
        cells = [_cell(outcome, method, row, values[method], best) for method in shown]
        table.add_row(Text(row), *cells, end_section=row == rows_of(outcome)[-1])
    for k in CUTOFFS:
        values = {method: shown_value(scores[method].success[k]) for method in scores}
        best = best_of(list(values.values()))
        table.add_row(
            Text(success_label(k)), *(_cell(outcome, method, None, values[method], best) for method in shown)
        )
    if any(_beside_paper(outcome, method) for method in shown):
        table.caption = Text(f"dim: {PAPER}, on its own shapes", style="dim")
    return table


def strengths_table(outcome: Outcome, method: str, scores: Scores) -> Table:
    """Return one method's mAP: a row for each transformation, a column for each limit of strength."""
    table = _table(f"{outcome.title}\n{method}, mAP in % by strength")
    for strength in STRENGTHS:
        table.add_column("1" if strength == 1 else f"≤{strength}", justify="right", no_wrap=True)
    for row in rows_of(outcome):
        values = [shown_value(value) for value in scores.mean_precision[row]]
        table.add_row(Text(row), *(Text(value) for value in values))
    return table


def heading(method: str) -> Text:
    """Return a method's name, one word a line."""
    return Text(method.replace("-", "-\n"))


def shown_value(value: float | None) -> str:
    """Return a percentage with one decimal."""
    return UNKNOWN if value is None else f"{value:.1f}"


def best_of(values: list[str]) -> str | None:
    """Return the highest of the numbers as shown; None where all are the same, or there is no other."""
    numbers = [value for value in values if value != UNKNOWN]
    return max(numbers, key=float) if len(set(numbers)) > 1 else None


def success_label(k: int) -> str:
    """Name the share of questions whose right answer is among the first k."""
    return "right at once" if k == 1 else f"right in first {k}"


def _table(title: str) -> Table:
    table = Table(
        title=Text(title),
        title_justify="left",
        caption_justify="left",
        box=box.SIMPLE_HEAD,
        padding=(0, BETWEEN - 1, 0, 0),
        pad_edge=False,
    )
    table.add_column("transformation", no_wrap=True)
    return table


def _size(outcome: Outcome) -> str:
    return f"{len(outcome.questions)} queries among {len(outcome.gallery)}"


def _beside_paper(outcome: Outcome, method: str) -> bool:
    """Tell whether the paper has a figure for any row."""
    return any(published(outcome.test, method, row) is not None for row in rows_of(outcome))


def _cell(outcome: Outcome, method: str, row: str | None, value: str, best: str | None) -> Text:
    """Return ours, then the paper's where the method has any, as wide in every row."""
    text = Text(value, style="bold" if value == best else "")
    if _beside_paper(outcome, method):
        theirs = published(outcome.test, method, row) if row is not None else None
        beside = UNKNOWN if theirs is None else f"{theirs:.0f}"
        text.append(f" {beside if row is not None else '':>3}", style="dim not bold")
    return text


def _fitting(outcome: Outcome, methods: Sequence[str], width: int) -> Iterator[list[str]]:
    """Yield the methods in as few groups as fit beside the names of the rows, of nearly equal size."""
    labels = [*rows_of(outcome), *(success_label(k) for k in CUTOFFS)]
    room = width - max(len(label) for label in labels) - BETWEEN
    widest = max(_width(outcome, method) for method in methods) + BETWEEN
    if sum(_width(outcome, method) + BETWEEN for method in methods) <= room:
        yield list(methods)
        return
    most = max(room // widest, 1)
    n_groups = -(-len(methods) // most)
    size = -(-len(methods) // n_groups)
    for start in range(0, len(methods), size):
        yield list(methods[start : start + size])


def _width(outcome: Outcome, method: str) -> int:
    """Return the characters of a method's column: its name, or 100.0 and the paper's 100."""
    return max(*map(len, heading(method).plain.split("\n")), 9 if _beside_paper(outcome, method) else 5)
