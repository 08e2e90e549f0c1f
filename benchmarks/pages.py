"""Pages of documentation whose tables are measured: what stands between their markers is replaced."""

import re
from collections.abc import Mapping, Sequence
from pathlib import Path

PARTS = re.compile(r"(<!-- table (\S+) -->\n)(.*?)(<!-- end -->)", re.DOTALL)

Row = Mapping[str, str]  # column → cell


def fill_page(page: Path, tables: Mapping[str, str]) -> None:
    """Put tables between the markers of a page's file."""
    page.write_text(fill(page.read_text(encoding="utf-8"), tables), encoding="utf-8")


def fill(page: str, tables: Mapping[str, str]) -> str:
    """Put tables between the markers of a page; one without new results stays as it is."""
    return PARTS.sub(lambda part: f"{part[1]}{tables.get(part[2], part[3])}{part[4]}", page)


def places_of(page: str) -> list[str]:
    """Return the names of a page's tables, in their order."""
    return [name for _, name, _, _ in PARTS.findall(page)]


def table_of(rows: Sequence[Row]) -> str:
    """Return rows of the same columns as a table in Markdown: text on the left, numbers on the right."""
    head = list(rows[0])
    rule = ["--:" if all(row[column][:1].isdigit() for row in rows) else "---" for column in head]
    return markdown(head, rule, [[row[column] for column in head] for row in rows])


def markdown(head: Sequence[str], rule: Sequence[str], lines: Sequence[Sequence[str]]) -> str:
    """Return a table of cells; the rule tells how columns are aligned."""
    return "".join(f"| {' | '.join(cells)} |\n" for cells in (head, rule, *lines))
