"""What `faience index` does: a batch with a progress bar, and a summary at its end."""

import contextlib
import json
import time
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path

from rich.console import Console
from rich.table import Table

from service.commands.batch import Outcome, Result, index_sources
from service.commands.discovery import Source, find_sources
from service.commands.failures import STOPPED, CommandFailed
from service.commands.opening import opened, working
from service.commands.progress import progress_bar
from service.settings import Settings

SHOWN = 20  # refusals in the summary; --json has all
AHEAD = 8  # shapes that wait, for each worker


def index_paths(paths: Sequence[Path], settings: Settings, allow_untextured: bool, as_json: bool) -> None:
    """Index meshes, report each, sum up.

    Raises
    ------
    CommandFailed
        A path does not exist, or nothing could be read.
    """
    sources = find_sources(paths)
    total = sum(len(source.meshes) for source in sources)
    if total == 0:
        raise CommandFailed(f"there is no .ply, .obj or .zip in {', '.join(map(str, paths))}")
    start = time.perf_counter()
    try:
        outcomes = _run(sources, total, settings, allow_untextured, as_json)
    except KeyboardInterrupt:
        raise CommandFailed("stopped; the same command goes on from here", STOPPED) from None
    _sum_up(outcomes, time.perf_counter() - start, as_json)


def _run(
    sources: Sequence[Source], total: int, settings: Settings, allow_untextured: bool, as_json: bool
) -> list[Outcome]:
    outcomes = []
    with contextlib.ExitStack() as stack:
        library = stack.enter_context(opened(settings, make=True))
        helper = stack.enter_context(working(library))
        advance = stack.enter_context(progress_bar("Indexing", total))
        for outcome in index_sources(library, sources, allow_untextured, helper, AHEAD):
            outcomes.append(outcome)
            advance()
            if as_json:
                print(_line(outcome), flush=True)  # noqa: T201 - this is the command's output
    return outcomes


def _line(outcome: Outcome) -> str:
    fields = {"path": outcome.path, "outcome": outcome.result, "id": outcome.shape_id, "code": outcome.code}
    return json.dumps(fields)


def _sum_up(outcomes: Sequence[Outcome], seconds: float, as_json: bool) -> None:
    counts = Counter(outcome.result for outcome in outcomes)
    if as_json:
        numbers = {str(result): counts[result] for result in Result}
        print(json.dumps({**numbers, "seconds": round(seconds, 3)}), flush=True)  # noqa: T201 - output
    else:
        _show(outcomes, counts, seconds)
    if counts[Result.ACCEPTED] + counts[Result.KNOWN] == 0:
        raise CommandFailed("none of the meshes could be read")


def _show(outcomes: Iterable[Outcome], counts: Counter[Result], seconds: float) -> None:
    console = Console()
    summary = Table("outcome", "meshes", title=f"Indexed in {seconds:.1f} s", title_justify="left")
    for result in Result:
        summary.add_row(result, str(counts[result]))
    console.print(summary)
    refused = [outcome for outcome in outcomes if outcome.result == Result.REFUSED]
    if not refused:
        return
    reasons = Table("refused", "code", "why", title_justify="left")
    for outcome in refused[:SHOWN]:
        reasons.add_row(*map(_plain, (outcome.path, outcome.code, outcome.detail)))
    console.print(reasons)
    if len(refused) > SHOWN:
        console.print(f"… and {len(refused) - SHOWN} more; --json lists all.")


def _plain(text: str | None) -> str:
    return (text or "").replace("[", r"\[")
