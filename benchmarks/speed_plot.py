"""Draw docs/speed.svg from what is kept in docs/speed.json: cost against size, described and searched.

Run by `make bench`, or alone, without measuring: python -m benchmarks.speed_plot.
"""

import io
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from benchmarks.measured import Measured, read_measured
from benchmarks.pages import Row
from service.evaluation.plots import COLOURS, DECIMALS, INK, NOTHING, STYLE

DOCS = Path(__file__).parents[1] / "docs"
FURTHER = 10  # times the largest library, on paper
VERTICES = (2_000, 5_000, 10_000, 20_000, 50_000, 200_000)  # ticks
GREY = "#8A9491"
FIRST, SECOND, THIRD = COLOURS[1], COLOURS[0], COLOURS[2]
LINE: Mapping[str, Any] = {
    "marker": "o",
    "markersize": 5,
    "markeredgecolor": "white",
    "markeredgewidth": 0.6,
    "linewidth": 1.8,
}
LEGEND: Mapping[str, Any] = {"loc": "upper left", "edgecolor": "none", "framealpha": 0.9, "borderpad": 0.2}
READ: Mapping[str, Any] = {**LINE, "marker": "s", "markersize": 4, "linewidth": 1.1, "linestyle": "--"}


def main() -> None:
    """Draw the plot again."""
    plot = speed_plot(read_measured(DOCS / "speed.json"))
    (DOCS / "speed.svg").write_text(plot, encoding="utf-8")


def speed_plot(measured: Measured) -> str:
    """Return both plots as SVG; what is not measured is left out."""
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(9.2, 3.9), layout=ConstrainedLayoutEngine(wspace=0.06))
        left, right = figure.subplots(1, 2)
        draw_describing(left, _rows(measured, "eigen-sizes"), _rows(measured, "job-sizes"))
        draw_searching(right, _rows(measured, "search-sizes"))
        content = io.StringIO()
        figure.savefig(content, format="svg", metadata=NOTHING)
    return DECIMALS.sub(r"\1", content.getvalue())


def draw_describing(axes: Axes, eigen: Sequence[Row], jobs: Sequence[Row]) -> None:
    """Draw processor time against vertices, with a line of slope 1."""
    lines = {
        f"{what}: file to description": series_of(jobs, "what", what, "vertices", "seconds")
        for what in dict.fromkeys(row["what"] for row in jobs)
    }
    if eigen:
        what = eigen[0]["what"]
        lines["eigen part, resolution as given"] = series_of(eigen, "what", what, "vertices", "ours, s")
    _frame(axes, "Describing a shape", "vertices", "processor time, s")
    for colour, (label, points) in zip((FIRST, THIRD, SECOND), lines.items(), strict=False):
        axes.plot(*points, color=colour, label=label, **LINE)
    if lines:
        _draw_slope(axes, list(lines.values())[-1])
        axes.set_xticks(VERTICES)
        axes.legend(**LEGEND)


def draw_searching(axes: Axes, rows: Sequence[Row]) -> None:
    """Draw milliseconds of a query against shapes, one read beside it, and both on paper beyond."""
    _frame(axes, "Finding the 20 nearest, exactly", "shapes in the library", "time, ms")
    for colour, name in zip((FIRST, SECOND), dict.fromkeys(row["method"] for row in rows), strict=False):
        for what, column, look in (
            (f"{name}: a query", "query, ms", LINE),
            (f"{name}: one read of all rows", "one read, ms", READ),
        ):
            points = series_of(rows, "method", name, "rows", column)
            axes.plot(*points, color=colour, label=what, **look)
            _draw_further(axes, points, colour, look)
    if rows:
        axes.plot([], [], "o", color=GREY, markerfacecolor="white", label="open: extrapolated, not measured")
        axes.legend(**LEGEND)


def series_of(
    rows: Sequence[Row], key: str, name: str, across: str, up: str
) -> tuple[list[float], list[float]]:
    """Return the numbers of two columns, in those rows whose key is this name."""
    chosen = [row for row in rows if row[key] == name]
    return [number(row[across]) for row in chosen], [number(row[up]) for row in chosen]


def number(cell: str) -> float:
    """Return the number that a cell shows."""
    return float(cell.replace(",", ""))


def further(points: tuple[Sequence[float], Sequence[float]]) -> tuple[float, float]:
    """Continue the slope between the last two sizes, both axes being logarithmic."""
    sizes, times = np.log(points[0][-2:]), np.log(points[1][-2:])
    slope = (times[1] - times[0]) / (sizes[1] - sizes[0])
    return FURTHER * points[0][-1], float(np.exp(times[1] + slope * np.log(FURTHER)))


def _draw_further(
    axes: Axes, points: tuple[Sequence[float], Sequence[float]], colour: str, look: Mapping[str, Any]
) -> None:
    if len(points[0]) < 2:
        return
    size, time = further(points)
    axes.plot([points[0][-1], size], [points[1][-1], time], ":", color=colour, linewidth=1.1, zorder=1)
    marker = {"marker": look["marker"], "markersize": look["markersize"]}
    axes.plot([size], [time], color=colour, markerfacecolor="white", linestyle="", **marker)


def _draw_slope(axes: Axes, points: tuple[Sequence[float], Sequence[float]]) -> None:
    """Draw how cost would grow in proportion to size, below what is measured."""
    sizes = np.array([min(points[0]), max(points[0])])
    times = 0.6 * min(np.divide(points[1], points[0])) * sizes
    axes.plot(sizes, times, "--", color=GREY, linewidth=1.0)
    middle = np.sqrt(sizes.prod()), np.sqrt(times.prod())
    axes.annotate(
        "in proportion (slope 1)",
        middle,
        (6, -4),
        textcoords="offset points",
        color=GREY,
        fontsize=8,
        va="top",
    )


def _frame(axes: Axes, title: str, across: str, up: str) -> None:
    axes.set(title=title, xlabel=across, ylabel=up, xscale="log", yscale="log")
    axes.title.set_color(INK)
    axes.minorticks_off()
    axes.xaxis.set_major_formatter(_short)
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
    axes.margins(y=0.12)


def _short(value: float, _: object) -> str:
    for unit, letter in ((1e6, "M"), (1e3, "k")):
        if value >= unit:
            return f"{value / unit:g} {letter}"
    return f"{value:g}"


def _rows(measured: Measured, name: str) -> Sequence[Row]:
    found: Sequence[Row] = measured.get(name, {}).get("rows", ())
    return found


if __name__ == "__main__":
    main()
