"""Plots of an evaluation as SVG, the same bytes from the same numbers. The one file that needs matplotlib."""

import io
import re
from collections.abc import Collection, Mapping, Sequence
from typing import Any

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.typing import RcKeyType

from service.evaluation.scores import STRENGTHS, Scores, best_method

# Okabe and Ito (2008), told apart with any colour vision; the yellow is darkened for a white ground.
COLOURS = ("#D55E00", "#0072B2", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#222222", "#A08F00")
MARKERS = ("o", "s", "^", "D", "v", "P", "X")  # 7 and 8 share no factor: 56 methods before a pair repeats
ACROSS = 4  # small plots beside each other
BARS_ACROSS = 7
LEGEND, HANDLE = 125, 7  # characters of a legend's line, and what stands before each name
GAP = 0.055  # between two labels, as a share of the axis
INK, FAINT = "#26302E", "#D9DEDB"
STYLE: dict[RcKeyType, Any] = {
    "svg.hashsalt": "faience",  # ids that do not change from run to run
    "svg.fonttype": "none",  # text stays text
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],  # comes with matplotlib: the same layout everywhere
    "font.size": 9,
    "axes.titlesize": 9,
    "axes.edgecolor": "#8A9491",
    "axes.labelcolor": INK,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "text.color": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": FAINT,
    "grid.linewidth": 0.6,
    "figure.facecolor": "white",
}
DECIMALS = re.compile(r"(\d\.\d\d)\d+")  # a hundredth of a point is enough; the rest is a third of the file
NOTHING = dict.fromkeys(("Date", "Creator", "Format", "Type"))  # no metadata, no date


def precision_recall_plot(scores: Mapping[str, Scores]) -> str:
    """Return precision against recall, a line for each method, labelled where it starts."""
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(5.2, 4.2), layout="constrained")
        axes = figure.add_subplot(xlim=(0, 1.02), ylim=(0, 1.05))
        axes.set(xlabel="recall: share of right answers found", ylabel="precision: share of answers right")
        for number, method in reversed(list(enumerate(scores))):  # the first method lies on top
            recall, precision = scores[method].precision_recall.T
            axes.plot(recall, precision, **_look(number), markevery=[0], linewidth=1.8, clip_on=False)
        _label_starts(axes, scores)
        return _svg(figure)


def strength_plot(scores: Mapping[str, Scores]) -> str:
    """Return mAP against strength: a small plot for each transformation, a line for each method."""
    rows = list(next(iter(scores.values())).by_strength)
    rows = rows[1:] if len(rows) == 2 else rows  # of one transformation, all is the same
    lines = -(-len(rows) // ACROSS)
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(9.2, 0.6 + 2.0 * lines), layout="constrained")
        grid = figure.subplots(lines, min(ACROSS, len(rows)), sharex=True, sharey=True, squeeze=False)
        for axes, row in zip(grid.flat, rows, strict=False):
            _draw_strengths(axes, row, scores)
        for axes in grid.flat[len(rows) :]:
            axes.set_visible(False)
        for axes in grid.flat[max(len(rows) - ACROSS, 0) : len(rows)]:  # nothing below them
            axes.tick_params(labelbottom=True)
        figure.supxlabel("strength", fontsize=9)
        figure.supylabel("mAP in %", fontsize=9)
        handles = [Line2D([], [], label=method, **_look(number)) for number, method in enumerate(scores)]
        figure.legend(handles=handles, loc="outside upper center", ncols=_columns(scores), frameon=False)
        return _svg(figure)


def bars_plot(scores: Mapping[str, Scores]) -> str:
    """Return mAP at all strengths: a column of bars for each method, a bar for each transformation."""
    rows = list(next(iter(scores.values())).mean_precision)
    lines = -(-len(scores) // BARS_ACROSS)
    across = min(len(scores), BARS_ACROSS)
    with mpl.rc_context(STYLE):
        size = (1.4 + 0.95 * max(across, 3), (0.5 + 0.24 * len(rows)) * lines + 0.3)
        figure = Figure(figsize=size, layout="constrained")
        grid = figure.subplots(lines, across, sharex=True, sharey=True, squeeze=False)
        for number, (axes, method) in enumerate(zip(grid.flat, scores, strict=False)):
            _draw_bars(axes, method, number, [scores[method].mean_precision[row][-1] for row in rows])
        for axes in grid.flat[len(scores) :]:
            axes.set_visible(False)
        grid[0, 0].set_yticks(range(len(rows)), rows)
        grid[0, 0].set_ylim(len(rows) - 0.4, -0.6)
        return _svg(figure)


def _draw_strengths(axes: Axes, row: str, scores: Mapping[str, Scores]) -> None:
    axes.set(title=row, xlim=(0.8, 5.2), ylim=(-3, 104), xticks=STRENGTHS, yticks=range(0, 101, 25))
    for number, method in reversed(list(enumerate(scores))):
        values = [float("nan") if v is None else v for v in scores[method].by_strength[row]]
        axes.plot(STRENGTHS, values, **_look(number), linewidth=1.5, clip_on=False)


def _draw_bars(axes: Axes, method: str, number: int, values: Sequence[float | None]) -> None:
    lengths = [value or 0.0 for value in values]
    axes.barh(range(len(values)), lengths, color=COLOURS[number % len(COLOURS)], height=0.72)
    axes.set(title=method.replace("-", "-\n"), xlim=(0, 138), xticks=[])
    axes.grid(visible=False)
    axes.spines["bottom"].set_visible(False)
    axes.tick_params(left=False)
    for place, value in enumerate(values):
        text = "" if value is None else f"{value:.0f}"
        axes.text(lengths[place] + 4, place, text, va="center", fontsize=8)


def _label_starts(axes: Axes, scores: Mapping[str, Scores]) -> None:
    """Write each method's name left of where its line starts.

    A line starts at recall = precision = the share right at once, and falls: above the diagonal is room.
    """
    best = best_method(scores)
    starts = {method: float(each.precision_recall[0, 0]) for method, each in scores.items()}
    heights = _spread(starts)
    for number, method in enumerate(scores):
        start, colour = starts[method], COLOURS[number % len(COLOURS)]
        axes.annotate(
            method,
            (start, start),
            (max(min(start, heights[method]) - 0.05, 0.30), heights[method]),
            color=colour,
            ha="right",
            va="center",
            fontweight="bold" if method == best else "normal",
            arrowprops={"arrowstyle": "-", "color": colour, "linewidth": 0.6, "shrinkA": 1, "shrinkB": 3},
        )


def _spread(starts: Mapping[str, float]) -> dict[str, float]:
    """Return heights near the wanted ones, in their order, at least a gap apart, and on the axes."""
    order = sorted(starts, key=lambda method: starts[method])
    heights: dict[str, float] = {}
    lowest = GAP
    for method in order:
        heights[method] = max(starts[method], lowest)
        lowest = heights[method] + GAP
    highest = 1.02
    for method in reversed(order):
        heights[method] = min(heights[method], highest)
        highest = heights[method] - GAP
    return heights


def _columns(names: Collection[str]) -> int:
    """Return how many names of a legend fit on a line."""
    if sum(len(name) + HANDLE for name in names) <= LEGEND:
        return len(names)
    return max(LEGEND // (max(map(len, names)) + HANDLE), 1)


def _look(number: int) -> dict[str, Any]:
    return {
        "color": COLOURS[number % len(COLOURS)],
        "marker": MARKERS[number % len(MARKERS)],
        "markersize": 4.5,
        "markeredgecolor": "white",
        "markeredgewidth": 0.5,
    }


def _svg(figure: Figure) -> str:
    content = io.StringIO()
    figure.savefig(content, format="svg", metadata=NOTHING)
    return DECIMALS.sub(r"\1", content.getvalue())
