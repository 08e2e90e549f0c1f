"""Alternatives measured on tests: the rows of a table, and the table as Markdown."""

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import replace
from functools import cache
from itertools import islice

import numpy as np

from benchmarks.alternatives import Alternative, Relative, Typical, alone
from benchmarks.variant_signatures import SECONDS
from index.methods import Method
from service.evaluation.cache import Described
from service.evaluation.measuring import Loaded, first_stage, measure
from service.evaluation.protocol import ISOMETRY, MIXED, PARTIALITY
from service.evaluation.registering import Additions
from service.evaluation.scores import ALL, Scores, score
from service.refining import LANDMARKS, QUERY_LADDER, QueryLandmarks, additions_to
from worker.arrays import FloatArray

PAPER, TWINS = "paper", "twins"  # tests
COLUMNS = (ALL, ISOMETRY, PARTIALITY, "noise", MIXED)  # of the paper's test
TWIN_COLUMN = "all, among twins"
TIMED = 20  # queries

Row = Mapping[str, str]  # column → cell
Cost = Callable[[Alternative, Loaded], str]


def rows_of(
    pool: Executor,
    tests: Mapping[str, Loaded],
    alternatives: Sequence[Alternative],
    additions: Additions,
    cost: tuple[str, Cost] | None = None,
) -> Iterator[Row]:
    """Yield mAP in per cent of each alternative, those of one method together.

    Parameters
    ----------
    pool : Executor
        Where shapes are registered.
    tests : mapping
        PAPER and, where there is one, TWINS.
    alternatives : sequence of Alternative
    additions : dict
        As in `measure`: what registration found in other tables.
    cost : (str, callable), optional
        One more column.
    """
    scores = {test: _scores(pool, loaded, alternatives, additions) for test, loaded in tests.items()}
    methods = list(dict.fromkeys(alternative.method for alternative in alternatives))
    for alternative in sorted(alternatives, key=lambda alternative: methods.index(alternative.method)):
        name = alternative.formula().name
        row = {"method": alternative.method, "choice": _emphasised(alternative)}
        row |= {column: _number(scores[PAPER][name].mean_precision[column][-1]) for column in COLUMNS}
        if TWINS in tests:
            row[TWIN_COLUMN] = _number(scores[TWINS][name].overall) if alternative.sees_colour() else ""
        yield row if cost is None else row | {cost[0]: cost[1](alternative, tests[PAPER])}


def table_of(rows: Sequence[Row]) -> str:
    """Return rows of the same columns as a table in Markdown."""
    head = list(rows[0])
    rule = ["---", "---", *["--:"] * (len(head) - 2)]
    lines = [head, rule, *([row[column] for column in head] for row in rows)]
    return "".join(f"| {' | '.join(cells)} |\n" for cells in lines)


def typical_of(shapes: Sequence[Described]) -> Typical:
    """Return what gives a block's mean distance between two of these shapes."""

    @cache
    def typical(name: str) -> float:
        distances = block_distances(name, shapes, shapes)
        return float(distances[~np.eye(len(shapes), dtype=np.bool_)].mean())

    return typical


def block_distances(name: str, queries: Sequence[Described], shapes: Sequence[Described]) -> FloatArray:
    """Return ‖x − y‖₁ of one block, (q, g)."""
    return first_stage(Method(name=name, blocks=alone(name), description=""), queries, shapes)


def relative_distances(alternative: Alternative, loaded: Loaded) -> FloatArray:
    """Return the sum of the blocks' distances, each in units of what is usual for the query; (q, g)."""
    usual = np.median if alternative.relative is Relative.MEDIAN else np.mean
    answered = [place for place, query in enumerate(loaded.queries) if query.refused is None]
    total = np.full((len(loaded.queries), len(loaded.shapes)), np.inf)
    total[answered] = 0.0
    for block in alternative.blocks:
        distances = block_distances(block.name, loaded.queries, loaded.shapes)[answered]
        total[answered] += distances / usual(distances, axis=1, keepdims=True)
    return total


def numbers(alternative: Alternative, loaded: Loaded) -> str:
    """Return how many numbers of a shape are compared."""
    return f"{sum(len(loaded.shapes[0].blocks[block.name]) for block in alternative.blocks):,}"


def milliseconds(alternative: Alternative, loaded: Loaded) -> str:
    """Return the processor time that the second stage takes for a query."""
    method = alternative.formula()
    distances = first_stage(method, loaded.queries, loaded.shapes)
    firsts = list(islice(loaded.firsts(method, distances), TIMED))
    start = time.process_time()
    for place, near in firsts:
        blocks = loaded.queries[place].blocks
        query = QueryLandmarks(packed=blocks[LANDMARKS], ladder=blocks[QUERY_LADDER])
        additions_to(query, {k: loaded.shapes[k].blocks[LANDMARKS] for k in near})
    return f"{1000.0 * (time.process_time() - start) / len(firsts):.0f}"


def seconds(_: Alternative, loaded: Loaded) -> str:
    """Return the processor time of the spectra with colours, of the median shape."""
    return f"{np.median([shape.blocks[SECONDS] for shape in loaded.shapes]):.1f}"


def _scores(
    pool: Executor, loaded: Loaded, alternatives: Sequence[Alternative], additions: Additions
) -> dict[str, Scores]:
    outcome = measure(pool, loaded, [alternative.formula() for alternative in alternatives], additions)
    relative = {
        alternative.formula().name: relative_distances(alternative, loaded)
        for alternative in alternatives
        if alternative.relative
    }
    return score(replace(outcome, distances={**outcome.distances, **relative}))


def _emphasised(alternative: Alternative) -> str:
    return f"**{alternative.label}**" if alternative.shipped else alternative.label


def _number(value: float | None) -> str:
    return "" if value is None else f"{value:.1f}"
