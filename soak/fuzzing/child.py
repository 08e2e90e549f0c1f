"""The process that judges a share of the mutants: `python -m soak.fuzzing.child ORDER`, one line for each.

It may crash, hang or run out of memory: whoever reads its lines (`watching.py`) knows at which mutant.
"""

import faulthandler
import gc
import importlib
import json
import math
import os
import resource
import sys
import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import cast

from service.jobs.rehearsal import rehearse
from soak.fuzzing.judging import ACCEPTED, Reader, Verdict, judge
from soak.fuzzing.mutating import Mutants
from soak.fuzzing.seeds import collect_seeds


@dataclass(frozen=True, kw_only=True)
class Order:
    """Which mutants are judged, and how."""

    folders: tuple[str, ...]  # of seeds, beside those written in code
    run: int  # another number gives other mutants
    first: int  # number of the first mutant
    end: int  # before which to stop
    step: int = 1  # from one to the next
    reader: str = "worker.reading.upload:read_mesh"  # module and name
    again_every: int = 50  # one mutant of so many is read twice
    whole_every: int = 10  # one mutant of so many is described, where it is accepted; 0: none
    cpu_seconds: int = 10  # of one mutant
    memory_bytes: int = 2 * 2**30  # address space beyond what the program itself takes


def main() -> None:
    """Judge what the order says."""
    values = json.loads(sys.argv[1])
    order = Order(**{**values, "folders": tuple(values["folders"])})
    answers = os.fdopen(os.dup(1), "w", buffering=1)
    os.dup2(2, 1)  # libraries that print must not disturb the answers
    faulthandler.enable()
    for line in _answers(order):
        answers.write(json.dumps(line) + "\n")


def _answers(order: Order) -> Iterator[dict[str, object]]:
    mutants = Mutants(collect_seeds([Path(folder) for folder in order.folders]), order.run)
    module, name = order.reader.split(":")
    reader = cast("Reader", getattr(importlib.import_module(module), name))
    if order.whole_every:
        rehearse()  # what is compiled is compiled before anything is limited
    gc.collect()
    gc.freeze()  # what the compiler left takes seconds to free, which would be some mutant's
    _limit_memory(order.memory_bytes)
    yield {"ready": True}
    for number in range(order.first, order.end, order.step):
        yield {"number": number, **_timed(order, mutants, reader, number)}


def _timed(order: Order, mutants: Mutants, reader: Reader, number: int) -> dict[str, object]:
    mutant = mutants.make(number)
    _limit_time(order.cpu_seconds)
    start = time.process_time()
    whole = order.whole_every > 0 and number % order.whole_every == 0
    verdict = judge(mutant, reader, again=number % order.again_every == 1, whole=whole)
    return asdict(verdict) | {
        "seed": mutant.seed,
        "cpu": time.process_time() - start,
        "described": whole and verdict == Verdict(outcome=ACCEPTED),
    }


def _limit_time(seconds: int) -> None:
    """Let the kernel end this process where one mutant takes longer."""
    _, hard = resource.getrlimit(resource.RLIMIT_CPU)
    resource.setrlimit(resource.RLIMIT_CPU, (math.ceil(time.process_time()) + seconds, hard))


def _limit_memory(room: int) -> None:
    taken = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (taken + room, taken + room))


if __name__ == "__main__":
    main()
