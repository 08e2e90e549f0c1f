"""An evaluation as one self-contained HTML page for people: tables, plots, queries with their answers."""

import base64
from collections.abc import Iterable, Iterator, Mapping, Sequence
from html import escape
from itertools import count
from pathlib import Path
from string import Template
from typing import Any

from index.methods import DEFAULT_METHOD, METHODS
from service.evaluation.album import Album
from service.evaluation.html_tables import methods_table, overview_table, strengths_table
from service.evaluation.outcome import Outcome
from service.evaluation.plots import bars_plot, precision_recall_plot, strength_plot
from service.evaluation.scores import Scores, best_method, score
from service.evaluation.showcase import choose_failures, choose_questions
from service.evaluation.strips import query_rows

TEMPLATE = Path(__file__).with_name("report.html")
COMPARED = "chks"  # the paper's method, shown under ours
AllScores = Mapping[str, Scores]


def write_report(
    path: Path,
    outcomes: Sequence[Outcome],
    pictures: Mapping[str, bytes],
    settings: Mapping[str, Any],
    method: str = DEFAULT_METHOD,
    compared: str = COMPARED,
) -> None:
    """Write the report.

    Parameters
    ----------
    outcomes : sequence of Outcome
        At least one; the first is the main one.
    pictures : mapping
        Name of a question or a gallery entry → PNG.
    settings : mapping
        How it was measured; shown at the end.
    method, compared : str
        Whose answers are shown; one that an outcome does not have is replaced by its best, or left out.
    """
    album = Album(pictures)
    scores = [score(outcome) for outcome in outcomes]
    pairs = list(zip(outcomes, scores, strict=True))
    queries = [_queries(*pair, album, shown_methods(pair[1], method, compared), compared) for pair in pairs]
    page = Template(TEMPLATE.read_text(encoding="utf-8")).substitute(
        lede=_lede(outcomes[0]),
        tiles=_tiles(outcomes[0], scores[0], method, compared),
        overview=overview_table(outcomes, scores),
        tests="\n".join(_test(*pair) for pair in pairs),
        queries="\n".join(map(_folded, [outcome.title for outcome in outcomes], queries, count())),
        methods=_methods(outcomes),
        settings="\n".join(_definitions((str(key), str(value)) for key, value in settings.items())),
        album=album.definitions(),
    )
    path.write_text(page, encoding="utf-8")


def shown_methods(scores: AllScores, method: str, compared: str) -> list[str]:
    """Return the method whose answers are shown, and the one to compare it with where there is one."""
    first = method if method in scores else best_method(scores)
    others = [other for other in (compared, best_method(scores)) if other in scores and other != first]
    return [first, *others[:1]]


def _lede(outcome: Outcome) -> str:
    """Say in two sentences what was measured."""
    models = len({question.model for question in outcome.questions})
    return (
        f"{len(outcome.questions):,} queries were made from {models} coloured models by bending, cutting, "
        f"relighting or recolouring them, and each method ranked {len(outcome.gallery):,} shapes by their "
        "likeness to each query, one of which is the model that it was made from. Mean average precision "
        "(mAP) is 100 % where that one always comes first, and 50 % where it always comes second."
    )


def _tiles(outcome: Outcome, scores: AllScores, method: str, compared: str) -> str:
    """Return the numbers to remember, of the main test."""
    first, *others = shown_methods(scores, method, compared)
    told = [
        ("right at once", [scores[name].success[1] for name in (first, *others)]),
        ("right among the first five", [scores[name].success[5] for name in (first, *others)]),
        ("mean average precision", [scores[name].overall for name in (first, *others)]),
    ]
    tiles = "".join(
        f"<li><strong>{values[0]:.1f} %</strong> {what}"
        + "".join(
            f"<small><code>{escape(name)}</code> {value:.1f} %</small>"
            for name, value in zip(others, values[1:], strict=True)
        )
        + "</li>"
        for what, values in told
    )
    return f"<p><code>{escape(first)}</code> in “{escape(outcome.title)}”:</p><ul>{tiles}</ul>"


def _test(outcome: Outcome, scores: AllScores) -> str:
    strengths = "\n".join(strengths_table(outcome, name, each) for name, each in scores.items())
    return f"""<section id="{escape(outcome.test)}"><h2>{escape(outcome.title)}</h2>
<p>{escape(outcome.explanation)} {len(outcome.questions):,} queries among {len(outcome.gallery):,} shapes.</p>
{methods_table(outcome, scores)}
<details><summary>By strength, method by method</summary><div class="side">{strengths}</div></details>
<div class="plots">
{_plot(strength_plot(scores), "How mAP falls as the changes grow stronger, by transformation")}
{_plot(precision_recall_plot(scores), "Precision against recall, over all queries: up and right is better")}
{_plot(bars_plot(scores), "mAP in % by transformation, a column of bars for each method")}
</div></section>"""


def _plot(svg: str, caption: str) -> str:
    """Return a plot as an image of its own, so that its ids do not meet those of another."""
    content = base64.b64encode(svg.encode()).decode()
    image = f'<img alt="{caption}; its numbers are in the tables" src="data:image/svg+xml;base64,{content}">'
    scrolling = f'<div class="scroll" tabindex="0">{image}</div>'
    return f"<figure>{scrolling}<figcaption>{caption}</figcaption></figure>"


def _queries(outcome: Outcome, scores: AllScores, album: Album, shown: Sequence[str], compared: str) -> str:
    """Return one test's queries and their first answers, then what its best method gets wrong."""
    best = best_method(scores)
    chosen = choose_questions(outcome, scores, shown)
    failures = choose_failures(scores[best], chosen)
    failed, asked = int((scores[best].ranks > 1).sum()), len(outcome.questions)
    said = f"is not right at once in {failed:,} of {asked:,} queries" if failed else "is always right at once"
    return f"""{query_rows(outcome, scores, chosen, shown, album)}
<h4><code>{escape(best)}</code> {said}{"; the worst" if failures else ""}</h4>
{query_rows(outcome, scores, failures, shown_methods(scores, best, compared), album)}"""


def _folded(title: str, content: str, number: int) -> str:
    """Return a part that opens and closes; the first is open."""
    start = "<details>" if number else "<details open>"
    return f"{start}<summary><h3>{escape(title)}</h3></summary>\n{content}\n</details>"


def _methods(outcomes: Sequence[Outcome]) -> str:
    names = dict.fromkeys(name for outcome in outcomes for name in outcome.distances)
    return "\n".join(_definitions((name, METHODS[name].description) for name in names if name in METHODS))


def _definitions(pairs: Iterable[tuple[str, str]]) -> Iterator[str]:
    return (f"<dt><code>{escape(name)}</code></dt><dd>{escape(text)}</dd>" for name, text in pairs)
