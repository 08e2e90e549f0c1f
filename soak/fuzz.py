"""Tens of thousands of damaged uploads before the readers: coded refusals or sound meshes, nothing else."""

import collections
import contextlib
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from service.commands.progress import progress_bar
from soak.fuzzing.child import Order
from soak.fuzzing.findings import keep
from soak.fuzzing.judging import ACCEPTED
from soak.fuzzing.mutating import Mutants
from soak.fuzzing.seeds import collect_seeds
from soak.fuzzing.watching import Judged, watch
from worker.errors import Code

_SHOWN = 40  # failures that are told; all are kept
_CODES = {str(code) for code in Code}


@dataclass(frozen=True, kw_only=True)
class FuzzResult:
    """What came of all mutants."""

    mutants: int
    refused: Mapping[str, int]  # by code, the most frequent first
    accepted: int
    described: int  # of the accepted, those that went through the whole worker
    failures: tuple[Judged, ...]  # broken promises, crashes, hangs
    seconds: float
    slowest: Judged | None  # by processor time


def run(
    mutants: int = 50_000,
    seed: int = 1,
    *,
    folders: Sequence[Path] = (),
    report: Callable[[str], None] = print,
    failures_in: Path | None = None,
    checked: bool = True,
) -> FuzzResult:
    """Judge mutants of small uploads.

    Parameters
    ----------
    mutants : int
        How many.
    seed : int
        Another one gives other mutants.
    folders : Sequence[Path]
        Meshes in them are mutated, beside those written in code.
    report : callable
        Takes the lines of the report.
    failures_in : Path, optional
        Where the files of failing mutants are kept; a new temporary folder unless given.
    checked : bool
        Let compiled loops check every index, which they do not in service: silent errors are seen.
    """
    start = time.monotonic()
    order = Order(folders=tuple(map(str, folders)), run=seed, first=0, end=mutants)
    with tempfile.TemporaryDirectory() as compiled, _progress(mutants) as advance:
        judged = []
        for one in watch(order, bounds=Path(compiled) if checked else None):
            judged.append(one)
            advance()
    result = _summed(judged, time.monotonic() - start)
    _keep_failures(result, order, failures_in)
    for line in lines_of(result):
        report(line)
    return result


def _summed(judged: Sequence[Judged], seconds: float) -> FuzzResult:
    outcomes = collections.Counter(one.outcome for one in judged)
    return FuzzResult(
        mutants=len(judged),
        refused={code: count for code, count in outcomes.most_common() if code in _CODES},
        accepted=outcomes[ACCEPTED],
        described=sum(one.described for one in judged),
        failures=tuple(one for one in judged if one.failure),
        seconds=seconds,
        slowest=max(judged, key=lambda one: one.cpu, default=None),
    )


def lines_of(result: FuzzResult) -> Iterator[str]:
    """Yield the report."""
    yield (
        f"fuzz: {result.mutants:,} mutants in {result.seconds:.0f} s: {result.accepted:,} accepted "
        f"({result.described:,} described), {sum(result.refused.values()):,} refused"
    )
    yield "  " + ", ".join(f"{code} {count:,}" for code, count in result.refused.items())
    if result.slowest is not None:
        slowest = result.slowest
        yield f"  slowest: {slowest.cpu:.2f} s, {slowest.seed} number {slowest.number} ({slowest.outcome})"
    for failure in result.failures[:_SHOWN]:
        last = failure.failure.strip().splitlines()[-1]
        yield f"  FAILED {failure.outcome}: {failure.seed} number {failure.number}: {last[:200]}"
    yield f"  {len(result.failures)} promises broken"


def _keep_failures(result: FuzzResult, order: Order, folder: Path | None) -> None:
    if not result.failures:
        return
    place = folder or Path(tempfile.mkdtemp(prefix="faience-fuzz-"))
    made = Mutants(collect_seeds([Path(name) for name in order.folders]), order.run)
    for failure in result.failures:
        keep(made.make(failure.number), f"{failure.outcome}: {failure.failure}", place)


@contextlib.contextmanager
def _progress(total: int) -> Iterator[Callable[..., None]]:
    """Show a bar where somebody looks."""
    if not sys.stderr.isatty():
        yield lambda: None
        return
    with progress_bar("mutants", total) as advance:
        yield advance
