"""Watches the process that judges; where it dies or hangs, tells at which mutant and starts the next."""

import json
import os
import selectors
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import IO

from soak.fuzzing.child import Order

STARTING = 900.0  # seconds until the first answer: everything is compiled anew once
_SHOWN = 3_000  # characters of what a dead process said


@dataclass(frozen=True, kw_only=True)
class Judged:
    """What came of one mutant."""

    number: int
    outcome: str  # “accepted”, a code, or how it failed
    failure: str = ""
    seed: str = ""  # unknown where the process died
    cpu: float = 0.0  # seconds
    described: bool = False


class NeverStarted(Exception):
    """The process ended before its first mutant; the text is what it said."""


def watch(order: Order, *, silence: float = 120.0, bounds: Path | None = None) -> Iterator[Judged]:
    """Judge the mutants of an order, each once, whatever happens to the processes.

    Parameters
    ----------
    order : Order
    silence : float
        Seconds by the clock after which one mutant counts as hanging.
    bounds : Path, optional
        Where compiled functions that check every index are kept; without it none is checked.
    """
    while order.first < order.end:
        died = None
        for judged in _one_process(order, silence, bounds):
            yield judged
            died = judged if judged.outcome in {"crash", "hang"} else None
            order = replace(order, first=judged.number + order.step)
        if died is None and order.first < order.end:
            raise NeverStarted("the process ended early without a reason")


def _one_process(order: Order, silence: float, bounds: Path | None) -> Iterator[Judged]:
    """Yield what one process answers; the last is a crash or a hang where it did not come to its end."""
    with tempfile.TemporaryFile() as said:
        child = subprocess.Popen(
            [sys.executable, "-m", "soak.fuzzing.child", json.dumps(asdict(order))],
            stdout=subprocess.PIPE,
            stderr=said,
            env=_environment(bounds),
        )
        assert child.stdout is not None
        number = None
        try:
            for line in _lines(child.stdout, silence):
                answer = json.loads(line)
                if "ready" in answer:
                    number = order.first
                else:
                    yield Judged(**answer)
                    number = answer["number"] + order.step
            if number is None or number < order.end:
                child.wait()  # it died: how is told by its exit code
        except TimeoutError:
            pass  # it hangs, and is ended
        finally:
            child.kill()
            child.wait()
            child.stdout.close()
        if number is None:
            raise NeverStarted(_end_of(said))
        if number < order.end:
            yield _death(number, child.returncode, _end_of(said))


def _death(number: int, exit_code: int, said: str) -> Judged:
    how = {
        -signal.SIGKILL: "gave no answer for too long, or no memory was left",
        -signal.SIGXCPU: "took too much processor time",
    }
    return Judged(
        number=number,
        outcome="hang" if exit_code in how else "crash",
        failure=f"{said}\nthe process {how.get(exit_code, 'died')} ({_way_of(exit_code)})",
    )


def _way_of(exit_code: int) -> str:
    """Name how a process ended: what it said may have been cut."""
    return f"exit code {exit_code}, {signal.strsignal(-exit_code) if exit_code < 0 else 'of its own'}"


def _lines(stream: IO[bytes], silence: float) -> Iterator[bytes]:
    """Yield whole lines until the stream ends.

    Raises
    ------
    TimeoutError
        It is silent for too long.
    """
    with selectors.DefaultSelector() as selector:
        selector.register(stream, selectors.EVENT_READ)
        rest, patience = b"", STARTING
        while selector.select(patience):
            data = os.read(stream.fileno(), 65_536)
            if not data:
                return
            *lines, rest = (rest + data).split(b"\n")
            yield from lines
            patience = silence
        raise TimeoutError


def _environment(bounds: Path | None) -> dict[str, str]:
    """Return the child's environment: one thread, and compiled functions that check indices or not.

    What numba keeps on disk does not say whether it checks, so that the two must not share a folder.
    """
    own = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    if bounds is not None:
        own |= {"NUMBA_BOUNDSCHECK": "1", "NUMBA_CACHE_DIR": str(bounds)}
    return {**os.environ, **own}


def _end_of(said: IO[bytes]) -> str:
    said.seek(0)
    return said.read()[-_SHOWN:].decode("utf-8", "replace")
