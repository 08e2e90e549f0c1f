"""Fill the tables of docs/choices.md: what the choices that the paper leaves open cost. By `make choices`.

On the protocol of `faience evaluate`; what is described is kept, so that a stopped run goes on from there.
"""

import argparse
import time
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import replace
from itertools import chain
from pathlib import Path

from threadpoolctl import threadpool_limits

from benchmarks.alternatives import TABLES, of_operator
from benchmarks.comparing import (
    PAPER,
    TWINS,
    Cost,
    Row,
    milliseconds,
    numbers,
    rows_of,
    seconds,
    table_of,
    typical_of,
)
from benchmarks.pages import fill_page
from benchmarks.variant_signatures import Bench, describe
from benchmarks.variant_words import learn, make_blocks
from service.commands.opening import pool_for
from service.commands.progress import progress_bar
from service.evaluation.folder import Folder, read_folder
from service.evaluation.measuring import Loaded, load
from service.evaluation.protocol import STRENGTHS
from service.evaluation.registering import Additions
from service.evaluation.suites import Suite, suites
from service.settings import Settings
from worker.parameters import Operator, Parameters

PAGE = Path(__file__).parents[1] / "docs" / "choices.md"
PRELOAD = ("benchmarks.variant_words", "service.evaluation.registering")
OPERATOR = "operator"  # table, and the test of fewer queries for it: mesh-laplace is several times slower
STRENGTH, MODELS = 3, slice(None, None, 3)  # of those queries
HOUR = 3_600  # that one process may take: the machine may be busy
COSTS: Mapping[str, tuple[str, Cost]] = {
    "words": ("numbers", numbers),
    "histogram": ("numbers", numbers),
    "curves": ("numbers", numbers),
    "second-stage": ("CPU ms a query", milliseconds),
    OPERATOR: ("CPU s, spectra with colour", seconds),
}


def main() -> None:
    """Describe, measure, fill in."""
    options = _options()
    folder = read_folder(options.folder)
    tests = suites_of(replace(folder, models=folder.models[: options.models]), options.strengths)
    bench = Bench(folder=options.folder, cache=options.cache, parameters=Parameters())
    settings = Settings(workers=options.workers, job_seconds=HOUR, job_cpu_seconds=HOUR)
    start = time.perf_counter()
    with threadpool_limits(1), pool_for(settings, PRELOAD) as pool:
        tables = {"measured": summary(tests), **measure_all(pool, bench, tests)}
    fill_page(options.page, tables)
    print(f"{options.page.name}: {', '.join(tables)}; {time.perf_counter() - start:.0f} s")


def suites_of(folder: Folder, strengths: Sequence[int]) -> dict[str, Suite]:
    """Return the paper's test and the one among twins at some strengths, and that of the operators."""
    found = {suite.test: suite for suite in suites(folder, twins=True, hard=False)}
    queries = tuple(query for query in found[PAPER].queries if query.strength in strengths)
    few = {model.name for model in folder.models[MODELS]}
    fewer = tuple(
        query for query in found[PAPER].queries if query.strength == STRENGTH and query.model in few
    )
    return {
        PAPER: replace(found[PAPER], queries=queries),
        TWINS: replace(found[TWINS], queries=queries),
        OPERATOR: replace(found[PAPER], queries=fewer),
    }


def prepare(pool: Executor, bench: Bench, tests: Mapping[str, Suite]) -> dict[str, Loaded]:
    """Describe the meshes of tests, with words learnt from the gallery of the first."""
    recipes = dict.fromkeys(chain.from_iterable(test.recipes() for test in tests.values()))
    gallery = next(iter(tests.values())).gallery
    describe(pool, bench, recipes)
    vocabulary = learn(pool, bench, [entry.recipe for entry in gallery])
    blocks = make_blocks(pool, bench, recipes, vocabulary)
    return {name: load(test, blocks) for name, test in tests.items()}


def measure_all(pool: Executor, bench: Bench, tests: Mapping[str, Suite]) -> dict[str, str]:
    """Return the tables by their markers."""
    loaded = prepare(pool, bench, tests)
    other = replace(bench, parameters=Parameters(operator=Operator.MESH_LAPLACE))
    operators = {
        Operator.COTANGENT: loaded.pop(OPERATOR),
        Operator.MESH_LAPLACE: prepare(pool, other, {OPERATOR: tests[OPERATOR]})[OPERATOR],
    }
    tables = {name: table_of(rows) for name, rows in _choices(pool, loaded)}
    return {**tables, OPERATOR: table_of(_operators(pool, operators))}


def summary(tests: Mapping[str, Suite]) -> str:
    """Return what is measured, in one sentence."""
    models = len({query.model for query in tests[PAPER].queries})
    strengths = sorted({query.strength for query in tests[PAPER].queries})
    return (
        f"{models} models at strengths {', '.join(map(str, strengths))}: {len(tests[PAPER].queries)} queries "
        f"among {len(tests[PAPER].gallery)} shapes, {len(tests[TWINS].gallery)} with the twins; "
        f"{len(tests[OPERATOR].queries)} queries for the operators.\n"
    )


def _choices(pool: Executor, tests: Mapping[str, Loaded]) -> Iterator[tuple[str, list[Row]]]:
    typical, additions = typical_of(tests[PAPER].shapes), Additions()
    with progress_bar("Measuring", len(TABLES)) as advance:
        for name, alternatives_of in TABLES.items():
            alternatives = list(alternatives_of(typical))
            yield name, list(rows_of(pool, tests, alternatives, additions, COSTS.get(name)))
            advance()


def _operators(pool: Executor, loaded: Mapping[Operator, Loaded]) -> list[Row]:
    """Return the rows of every operator, methods together."""
    rows = [
        row
        for operator, test in loaded.items()
        for row in rows_of(pool, {PAPER: test}, of_operator(operator), Additions(), COSTS[OPERATOR])
    ]
    methods = list(dict.fromkeys(row["method"] for row in rows))
    return sorted(rows, key=lambda row: methods.index(row["method"]))


def _options() -> argparse.Namespace:
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("folder", type=Path, help="as for `faience evaluate`")
    arguments.add_argument("--models", type=int, help="only the first so many")
    arguments.add_argument("--strengths", type=_strengths, default=(1, 3, 5), help="separated by commas")
    arguments.add_argument("--cache", type=Path, default=Path("faience-choices"))
    arguments.add_argument("--page", type=Path, default=PAGE, help="whose tables are filled")
    arguments.add_argument("--workers", type=int, default=2)
    return arguments.parse_args()


def _strengths(text: str) -> tuple[int, ...]:
    found = tuple(int(part) for part in text.split(","))
    if not set(found) <= set(STRENGTHS):
        raise argparse.ArgumentTypeError(f"strengths are {STRENGTHS}, separated by commas, not {text!r}")
    return found


if __name__ == "__main__":
    main()
