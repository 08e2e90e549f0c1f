"""Kills without warning, while clients upload, remove and ask; then every promise is looked at."""

import os
import random
import signal
import time
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import httpx

from soak.clients import clients
from soak.ledger import Ledger
from soak.processes import Command, ending, free_port, kill, serve, start, wait_until, work
from soak.promises import broken_promises

LEASE = 3.0  # seconds until a dead worker's job is another's
PACE = 0.8  # seconds between uploads, unless told
LIVES = (0.2, 3.0)  # seconds between two kills, from and to
LOOKED_AT = 10  # acknowledged shapes asked for after each restart
ENVIRONMENT = {
    "FAIENCE_LEASE_SECONDS": f"{LEASE:g}",
    "FAIENCE_POLL_SECONDS": "0.1",
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
}
TARGETS = ("api", "worker", "child")
MACHINE = "machine"  # one that computes for a cluster
ODDS = {"api": 3, "worker": 3, "child": 4, MACHINE: 3}
DAMAGED, PAUSED = 0.5, 0.1  # how often an index file is damaged after a kill of the API, a worker stopped


@dataclass(frozen=True, kw_only=True)
class CrashFigures:
    """What was done, and what came of it."""

    harm: Counter[str]  # kills by target; also index files "damaged", and workers "paused" past their leases
    seconds: float
    acknowledged: int  # uploads
    removed: int  # shapes
    unanswered: int  # uploads that were cut off and never told
    answers: Counter[str]  # "what status" → how often
    broken: list[str]  # promises; empty is right


def run(
    folder: Path,
    n_kills: int,
    seed: int,
    report: Callable[[int], None] = lambda _: None,
    machines: Sequence[Command] = (),
    pace: float = PACE,
) -> CrashFigures:
    """Kill the API, a worker, a machine of their cluster, or one of their children, again and again.

    Parameters
    ----------
    folder : Path
        An empty place for the library and the logs.
    report : callable
        Told how many kills are done.
    machines : sequence of Command
        What computes for the cluster that the environment names.
    pace : float
        Seconds between uploads.
    """
    began = time.monotonic()
    port, ledger = free_port(), Ledger()
    library = folder / "library"
    api, worker = serve(library, port, 1, ENVIRONMENT), work(library, ENVIRONMENT)
    harm: Counter[str] = Counter()
    targets = (*TARGETS, MACHINE) if machines else TARGETS
    with ending(api, worker):
        _revive(api, worker, machines, port)
        with clients(port, ledger, seed, pace):
            generator = random.Random(seed)
            while kills_of(harm) < n_kills:
                time.sleep(generator.uniform(*LIVES))
                done = kills_of(harm)
                target = targets[done] if done < len(targets) else _draw(targets, generator)
                harm.update(_harm(target, generator, api, worker, machines, library))
                _revive(api, worker, machines, port)
                _look(port, ledger, generator)
                report(kills_of(harm))
            wait_until(lambda: ledger.answers["similar 200"] > 0, "a ranked answer")
        wait_until(lambda: _all_ended(port), "the end of every job")
        api.stop()
        worker.stop()
    return CrashFigures(
        harm=harm,
        seconds=time.monotonic() - began,
        acknowledged=len(ledger.acknowledged),
        removed=len(ledger.removed),
        unanswered=len(ledger.unanswered),
        answers=ledger.answers,
        broken=broken_promises(library, ledger),
    )


def kills_of(harm: Counter[str]) -> int:
    """Return how many kills there were."""
    return sum(harm[target] for target in (*TARGETS, MACHINE))


def _draw(targets: Sequence[str], generator: random.Random) -> str:
    return generator.choices(targets, [ODDS[target] for target in targets])[0]


def _harm(
    target: str,
    generator: random.Random,
    api: Command,
    worker: Command,
    machines: Sequence[Command],
    library: Path,
) -> list[str]:
    """Kill something, and perhaps do more; return what was done."""
    done = _kill_one(target, generator, api, worker, machines)
    if not api.running() and generator.random() < DAMAGED:
        done += _damage(library / "index", generator)
    if worker.running() and generator.random() < PAUSED:
        done += _pause(worker)
    return done


def _revive(api: Command, worker: Command, machines: Sequence[Command], port: int) -> None:
    for each in (worker, *machines):
        if not each.running():
            each.start()
    start(api, port)


def _kill_one(
    target: str, generator: random.Random, api: Command, worker: Command, machines: Sequence[Command]
) -> list[str]:
    """Kill a target; return it, or nothing where it had just ended by itself."""
    if target == "api":
        api.kill()
    elif target == "worker":
        worker.kill()
    elif target == MACHINE:
        generator.choice(machines).kill()
    else:
        family = [child for each in (api, worker, *machines) for child in each.family()]
        if not family or not kill(generator.choice(family)):
            return []
    return [target]


def _damage(folder: Path, generator: random.Random) -> list[str]:
    """Change or cut one index file, if there is any."""
    files = sorted(folder.glob("*.vectors"))
    if not files:
        return []
    path = generator.choice(files)
    data = bytearray(path.read_bytes())
    place = generator.randrange(len(data))
    if generator.random() < 0.5:
        data[place] ^= 1 << generator.randrange(8)
    else:
        del data[place:]
    path.write_bytes(data)
    return ["damaged"]


def _pause(worker: Command) -> list[str]:
    """Stop a worker for longer than its leases, as a machine does that sleeps; then let it go on."""
    os.kill(worker.pid, signal.SIGSTOP)
    time.sleep(1.5 * LEASE)
    os.kill(worker.pid, signal.SIGCONT)
    return ["paused"]


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
