"""Kills without warning, while clients upload, remove and ask; then every promise is looked at."""

import random
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import httpx

from soak.clients import clients
from soak.ledger import Ledger
from soak.processes import Command, ending, free_port, kill, serve, start, wait_until, work
from soak.promises import broken_promises

LEASE = 3.0  # seconds until a dead worker's job is another's
PACE = 0.8  # seconds between uploads
LIVES = (0.2, 3.0)  # seconds between two kills, from and to
LOOKED_AT = 10  # acknowledged shapes asked for after each restart
ENVIRONMENT = {
    "FAIENCE_LEASE_SECONDS": f"{LEASE:g}",
    "FAIENCE_POLL_SECONDS": "0.1",
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
}
TARGETS = ("api", "worker", "child")
ODDS = (3, 3, 4)


@dataclass(frozen=True, kw_only=True)
class CrashFigures:
    """What was done, and what came of it."""

    kills: Counter[str]  # by what was killed
    seconds: float
    acknowledged: int  # uploads
    removed: int  # shapes
    unanswered: int  # uploads that were cut off and never told
    answers: Counter[str]  # "what status" → how often
    broken: list[str]  # promises; empty is right


def run(
    folder: Path, n_kills: int, seed: int, report: Callable[[int], None] = lambda _: None
) -> CrashFigures:
    """Kill the API, a worker or one of their children again and again.

    Parameters
    ----------
    folder : Path
        An empty place for the library and the logs.
    report : callable
        Told how many kills are done.
    """
    began = time.monotonic()
    port, ledger = free_port(), Ledger()
    library = folder / "library"
    api, worker = serve(library, port, 1, ENVIRONMENT), work(library, ENVIRONMENT)
    kills: Counter[str] = Counter()
    with ending(api, worker):
        _revive(api, worker, port)
        with clients(port, ledger, seed, PACE):
            generator = random.Random(seed)
            while kills.total() < n_kills:
                time.sleep(generator.uniform(*LIVES))
                kills.update(_kill_one(generator, api, worker))
                _revive(api, worker, port)
                _look(port, ledger, generator)
                report(kills.total())
        wait_until(lambda: _all_ended(port), "the end of every job")
        api.stop()
        worker.stop()
    return CrashFigures(
        kills=kills,
        seconds=time.monotonic() - began,
        acknowledged=len(ledger.acknowledged),
        removed=len(ledger.removed),
        unanswered=len(ledger.unanswered),
        answers=ledger.answers,
        broken=broken_promises(library, ledger),
    )


def _revive(api: Command, worker: Command, port: int) -> None:
    if not worker.running():
        worker.start()
    start(api, port)


def _kill_one(generator: random.Random, api: Command, worker: Command) -> list[str]:
    """Kill something; return what, or nothing where it had just ended by itself."""
    target = generator.choices(TARGETS, ODDS)[0]
    if target == "api":
        api.kill()
    elif target == "worker":
        worker.kill()
    else:
        family = [*api.family(), *worker.family()]
        if not family or not kill(generator.choice(family)):
            return []
    return [target]


def _look(port: int, ledger: Ledger, generator: random.Random) -> None:
    """Ask for some of what was acknowledged; it must be there whatever was killed."""
    with httpx.Client(base_url=f"http://127.0.0.1:{port}", timeout=60) as client:
        for _ in range(LOOKED_AT):
            shape_id = ledger.pick(generator)
            if shape_id is None:
                return
            status = client.get(f"/v1/shapes/{shape_id}").status_code
            expected = {200, 404} if shape_id in ledger.removing else {200}  # a client removed it just now
            ledger.note("get after a kill", status, frozenset(expected), shape_id)


def _all_ended(port: int) -> bool:
    url = f"http://127.0.0.1:{port}/v1/shapes"
    return not any(
        httpx.get(url, params={"status": status, "limit": 1}, timeout=60).json()["items"]
        for status in ("queued", "processing")
    )
