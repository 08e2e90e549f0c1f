"""The scores of an evaluation as HTML tables, shaded by value."""

from collections.abc import Iterable, Mapping, Sequence
from html import escape

from service.evaluation.outcome import Outcome
from service.evaluation.paper import PAPER, published
from service.evaluation.scores import ALL, CUTOFFS, STRENGTHS, Scores, rows_of
from service.evaluation.tables import best_of, shown_value, success_label


def overview_table(outcomes: Sequence[Outcome], scores: Sequence[Mapping[str, Scores]]) -> str:
    """Return mAP over all queries: a row for each test, a column for each method."""
    methods = list(dict.fromkeys(method for each in scores for method in each))
    head = ["test", "queries", "among", *map(_code, methods)]
    rows = [
        _row(
            f'<a href="#{escape(outcome.test)}">{escape(outcome.title)}</a>',
            _values([each[method].overall if method in each else None for method in methods]),
            [f"<td>{len(outcome.questions):,}</td>", f"<td>{len(outcome.gallery):,}</td>"],
        )
        for outcome, each in zip(outcomes, scores, strict=True)
    ]
    return _table("Mean average precision in %, all queries of each test", head, rows)


def methods_table(outcome: Outcome, scores: Mapping[str, Scores]) -> str:
    """Return mAP at all strengths: a row for each transformation, a column for each method.

    The best of a row is bold; the paper's figure stands beside ours, small.
    """
    theirs = {row: [published(outcome.test, method, row) for method in scores] for row in rows_of(outcome)}
    beside = [any(value is not None for value in column) for column in zip(*theirs.values(), strict=True)]
    rows = []
    for row in rows_of(outcome):
        values = _values([each.mean_precision[row][-1] for each in scores.values()], beside, theirs[row])
        rows.append(_row(_breaking(row), values, kind="whole" if row == ALL else ""))
    for k in CUTOFFS:
        values = _values([each.success[k] for each in scores.values()], beside)
        rows.append(_row(success_label(k), values, kind="part" if k == CUTOFFS[0] else ""))
    caption = "Mean average precision in %, strengths 1 to 5"
    if any(beside):
        caption += f"; small: {PAPER}, on its own shapes, where known"
    return _table(caption, ["transformation", *map(_code, scores)], rows)


def strengths_table(outcome: Outcome, method: str, scores: Scores) -> str:
    """Return one method's mAP: a row for each transformation, a column for each limit of strength."""
    head = ["transformation", *("1" if strength == 1 else f"≤ {strength}" for strength in STRENGTHS)]
    rows = [
        _row(_breaking(row), [_cell(value) for value in scores.mean_precision[row]])
        for row in rows_of(outcome)
    ]
    return _table(f"{_code(method)} by strength", head, rows)


def _code(method: str) -> str:
    return f"<code>{escape(method).replace('-', '-<wbr>')}</code>"


def _breaking(row: str) -> str:
    return escape(row).replace("+", "+<wbr>")


def _table(caption: str, head: Iterable[str], rows: Iterable[str]) -> str:
    """Return a table in a frame that scrolls sideways, also by keyboard."""
    columns = "".join(f'<th scope="col">{name}</th>' for name in head)
    return (
        f'<div class="scroll" tabindex="0"><table><caption><span>{caption}</span></caption>'
        f"<thead><tr>{columns}</tr></thead><tbody>\n{''.join(rows)}</tbody></table></div>"
    )


def _row(name: str, cells: Sequence[str], before: Sequence[str] = (), *, kind: str = "") -> str:
    start = f'<tr class="{kind}">' if kind else "<tr>"
    return f'{start}<th scope="row">{name}</th>{"".join([*before, *cells])}</tr>\n'


def _values(
    values: Sequence[float | None], beside: Sequence[bool] = (), theirs: Sequence[float | None] = ()
) -> list[str]:
    """Return a row's cells, the best bold; those of a column with figures beside keep room for one."""
    best = best_of([shown_value(value) for value in values])
    smalls = [
        _beside(theirs[k] if theirs else None, bool(theirs)) if beside and beside[k] else ""
        for k in range(len(values))
    ]
    return [
        _cell(value, small, bold=shown_value(value) == best)
        for value, small in zip(values, smalls, strict=True)
    ]


def _beside(value: float | None, known: bool) -> str:
    text = shown_value(None) if value is None else f"{value:.0f}"
    return f' <small class="beside">{text if known else ""}</small>'


def _cell(value: float | None, small: str = "", *, bold: bool = False) -> str:
    """Return a percentage, its cell the stronger in colour the higher."""
    if value is None:
        return f'<td class="none">{shown_value(None)}</td>'
    number = f"<b>{shown_value(value)}</b>" if bold else shown_value(value)
    return f'<td class="value" style="--share:{(value / 100) ** 2:.2f}">{number}{small}</td>'
