"""What `faience evaluate` does: describe with a progress bar, measure, tell."""

import json
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rich.console import Console

from index.methods import DEFAULT_METHOD, METHODS, Method, method
from index.vocabulary import default_vocabulary
from service.commands.failures import STOPPED, CommandFailed
from service.commands.opening import pool_for
from service.commands.progress import progress_bar
from service.evaluation.ablation import ablations, whole_methods
from service.evaluation.as_json import as_document
from service.evaluation.describing import Setting, describe_all, missing
from service.evaluation.folder import BadFolder, read_folder
from service.evaluation.measuring import GalleryRefused, Loaded, load, measure
from service.evaluation.outcome import Outcome
from service.evaluation.pictures import Pictures
from service.evaluation.registering import Additions
from service.evaluation.report import write_report
from service.evaluation.suites import Suite, suites
from service.evaluation.tables import outcome_tables
from service.settings import Settings
from worker.parameters import Parameters

PRELOAD = ("service.evaluation.describing", "service.evaluation.registering")
REPORT, RESULTS, CACHE = "report.html", "results.json", "cache"


@dataclass(frozen=True, kw_only=True)
class Plan:
    """What is to be measured."""

    methods: tuple[str, ...] = ()  # all where there is none
    twins: bool = False  # the tests that cost little more
    hard: bool = False  # those and the long ones
    ablation: bool = False  # `fused` without each of its parts, too

    def chosen(self) -> list[Method]:
        """Return the methods; UnknownMethod for a name that is none."""
        chosen = [method(name) for name in self.methods or METHODS]
        return chosen + (ablations(METHODS[DEFAULT_METHOD]) if self.ablation else [])


def evaluate_folder(folder: Path, out: Path, plan: Plan, workers: int | None, as_json: bool) -> None:
    """Measure, write the report and the results, and show the tables.

    Raises
    ------
    CommandFailed
        The folder does not hold what is needed.
    """
    start = time.perf_counter()
    methods = plan.chosen()
    settings = Settings() if workers is None else Settings(workers=workers)
    try:
        tests = suites(read_folder(folder), twins=plan.twins, hard=plan.hard)
        out.mkdir(parents=True, exist_ok=True)
        setting = Setting(
            folder=folder, cache=out / CACHE, parameters=Parameters(), vocabulary=default_vocabulary()
        )
        with pool_for(settings, PRELOAD) as pool:
            _describe(pool, setting, tests)
            outcomes = list(_measure(pool, setting, tests, methods))
    except (BadFolder, GalleryRefused) as error:
        raise CommandFailed(str(error)) from None
    except KeyboardInterrupt:
        raise CommandFailed("stopped; the same command goes on from here", STOPPED) from None
    known = {
        "folder": folder.name,
        "descriptors": setting.parameters.fingerprint(),
        "vocabulary": setting.vocabulary.id,
    }
    _tell(outcomes, known, Pictures(setting, tests), out, as_json)
    if not as_json:
        Console(stderr=True).print(f"{time.perf_counter() - start:.0f} s; {out / REPORT}, {out / RESULTS}")


def _describe(pool: Executor, setting: Setting, tests: Sequence[Suite]) -> None:
    recipes = {recipe: None for test in tests for recipe in test.recipes()}
    todo = missing(setting.open_cache(), recipes)
    with progress_bar("Describing", len(recipes)) as advance:
        done = len(recipes) - len(todo)
        advance(completed=done, total=len(recipes))
        for more in describe_all(pool, setting, todo):
            done += more
            advance(completed=done, total=len(recipes))


def _measure(
    pool: Executor, setting: Setting, tests: Sequence[Suite], methods: Sequence[Method]
) -> Iterator[Outcome]:
    cache, additions = setting.open_cache(), Additions()
    with progress_bar("Measuring", len(tests)) as advance:
        for test in tests:
            loaded: Loaded = load(test, cache)
            yield measure(pool, loaded, methods, additions)
            advance()


def _tell(
    outcomes: Sequence[Outcome], known: dict[str, Any], pictures: Pictures, out: Path, as_json: bool
) -> None:
    document = as_document(outcomes, known)
    (out / RESULTS).write_text(json.dumps(document, indent=1) + "\n", encoding="utf-8")
    write_report(out / REPORT, [whole_methods(outcome) for outcome in outcomes], pictures, known)
    if as_json:
        print(json.dumps(document), flush=True)  # noqa: T201 - this is the command's output
        return
    console = Console()
    for outcome in outcomes:
        for table in outcome_tables(outcome, console.width):
            console.print(table)
