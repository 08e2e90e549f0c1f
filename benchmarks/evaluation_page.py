"""Fill the tables of docs/evaluation.md from the results of `faience evaluate`. Run by `make evaluation`."""

import argparse
import json
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from benchmarks.pages import fill_page, markdown

PAGE = Path(__file__).parents[1] / "docs" / "evaluation.md"
STRENGTHS = ("1", "≤ 2", "≤ 3", "≤ 4", "≤ 5")
DETAILED = ("fused", "chks")  # methods whose strengths are shown one by one
PLAIN = re.compile(r"[^:,]+")  # a method's name, without what an ablation left out of it

Methods = Mapping[str, Mapping[str, Mapping[str, Sequence[float | None]]]]


def main() -> None:
    """Rewrite what stands between the page's markers; a table without new results stays as it is."""
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("results", type=Path)
    document = json.loads(arguments.parse_args().results.read_text(encoding="utf-8"))
    tables = {name: table for test in document["tests"] for name, table in tables_of(test).items()}
    fill_page(PAGE, tables)
    print(f"{PAGE.name}: {', '.join(tables)}")


def tables_of(test: Mapping[str, Any]) -> dict[str, str]:
    """Return the tables of one test, by the names of their markers."""
    methods: Methods = test["methods"]
    plain = {name: scores for name, scores in methods.items() if PLAIN.fullmatch(name)}
    tables = {test["test"]: by_method(plain)}
    if len(methods) > len(plain):
        tables[f"{test['test']}-ablation"] = ablation(methods)
    for name in DETAILED:
        if name in methods:
            tables[f"{test['test']}-{name}"] = by_strength(methods[name]["map"])
    return tables


def by_method(methods: Methods) -> str:
    """Return mAP at all strengths, rows by transformation, columns by method."""
    rows = next(iter(methods.values()))["map"]
    lines = [[row, *(_number(methods[name]["map"][row][-1]) for name in methods)] for row in rows]
    return _table(["", *(f"`{name}`" for name in methods)], lines)


def by_strength(rows: Mapping[str, Sequence[float | None]]) -> str:
    """Return one method's mAP, columns by strength."""
    return _table(["", *STRENGTHS], [[row, *map(_number, values)] for row, values in rows.items()])


def ablation(methods: Methods) -> str:
    """Return mAP at all strengths, rows by version of `fused`, columns by its hardest transformations."""
    versions = {name: scores["map"] for name, scores in methods.items() if name.startswith("fused")}
    hardest = sorted(
        next(iter(versions.values())),
        key=lambda row: min(found[row][-1] or 0.0 for found in versions.values()),
    )
    shown = ["all", *(row for row in hardest if row != "all")][:7]
    lines = [[name, *(_number(found[row][-1]) for row in shown)] for name, found in versions.items()]
    return _table(["", *shown], lines)


def _table(head: Sequence[str], lines: Sequence[Sequence[str]]) -> str:
    return markdown(head, ["---", *["--:"] * (len(head) - 1)], lines)


def _number(value: float | None) -> str:
    return "" if value is None else f"{value:.1f}"


if __name__ == "__main__":
    main()
