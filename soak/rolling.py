"""A rolling restart: the API processes of one library end and start in turn while queries flow."""

import contextlib
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import count

import httpx

from soak.processes import PATIENCE, Command, start, wait_until

LOOK_EVERY = 0.05  # seconds between two looks at a process's readiness
ENOUGH = 5  # queries that each process answers between two restarts


@dataclass(frozen=True, kw_only=True)
class Backend:
    """One API process."""

    command: Command
    port: int

    @property
    def url(self) -> str:
        """Return where it listens."""
        return f"http://127.0.0.1:{self.port}"


@dataclass
class Balancer:
    """Sends each request to the next process that says it is ready; nothing is tried twice."""

    backends: Sequence[Backend]
    ready: dict[str, bool] = field(default_factory=dict)
    under_way: Counter[str] = field(default_factory=Counter)
    answered: Counter[str] = field(default_factory=Counter)
    lock: threading.Lock = field(default_factory=threading.Lock)
    turns: Iterator[int] = field(default_factory=count)

    def look(self) -> None:
        """Ask each process whether it is ready."""
        for backend in self.backends:
            with contextlib.suppress(httpx.TransportError):
                ready = httpx.get(f"{backend.url}/readyz", timeout=PATIENCE).status_code == httpx.codes.OK
                self.ready[backend.url] = ready
                continue
            self.ready[backend.url] = False

    @contextlib.contextmanager
    def sent(self) -> Iterator[str]:
        """Yield the address for one request."""
        with self.lock:
            urls = [each.url for each in self.backends if self.ready.get(each.url)]
            url = urls[next(self.turns) % len(urls)]  # IndexError where nobody is left: that is a failure too
            self.under_way[url] += 1
        try:
            yield url
        finally:
            with self.lock:
                self.under_way[url] -= 1
                self.answered[url] += 1

    def turned_away(self, backend: Backend) -> bool:
        """Return whether nothing is sent there, nor under way."""
        with self.lock:
            return not self.ready[backend.url] and not self.under_way[backend.url]


@dataclass(frozen=True, kw_only=True)
class RollingFigures:
    """What came of the queries."""

    queries: int
    restarts: int
    slowest: float  # seconds of a query
    broken: tuple[str, ...]  # queries that failed or were answered otherwise


def roll(
    backends: Sequence[Backend], expected: Mapping[str, object], read: Callable[[object], object]
) -> RollingFigures:
    """Restart each process once while queries flow.

    Parameters
    ----------
    backends : sequence of Backend
        At least two, with `FAIENCE_DRAIN_SECONDS` for so long that the balancer turns away meanwhile.
    expected : mapping of str to object
        Path → what ``read`` makes of its answer.
    read : callable
        Takes the JSON of an answer.
    """
    balancer, broken, seconds = Balancer(backends), list[str](), list[float]()
    for backend in backends:
        backend.command.start()
    for backend in backends:
        start(backend.command, backend.port)
    balancer.look()
    with _beside(balancer.look), _beside(lambda: _ask(balancer, expected, read, broken, seconds)):
        for backend in backends:
            _wait_for_answers(balancer)
            _restart(balancer, backend)
        _wait_for_answers(balancer)
    return RollingFigures(
        queries=len(seconds), restarts=len(backends), slowest=max(seconds), broken=tuple(broken)
    )


def _restart(balancer: Balancer, backend: Backend) -> None:
    process = backend.command.process
    assert process is not None
    process.terminate()
    wait_until(lambda: balancer.turned_away(backend), "the balancer's turning away")
    process.terminate()  # a second signal: nobody is there whom the rest of the time would serve
    process.wait(PATIENCE)
    start(backend.command, backend.port)


def _wait_for_answers(balancer: Balancer) -> None:
    before = Counter(balancer.answered)

    def enough() -> bool:
        more = balancer.answered - before
        return all(more[each.url] >= ENOUGH for each in balancer.backends)

    wait_until(enough, "answers of every process")


def _ask(
    balancer: Balancer,
    expected: Mapping[str, object],
    read: Callable[[object], object],
    broken: list[str],
    seconds: list[float],
) -> None:
    for path, answer in expected.items():
        began = time.monotonic()
        try:
            with balancer.sent() as url:
                got = read(httpx.get(f"{url}{path}", timeout=PATIENCE).raise_for_status().json())
            if got != answer:
                broken.append(f"{path}: {got} in place of {answer}")
        except Exception as error:  # noqa: BLE001 - whatever it is, a query failed
            broken.append(f"{path}: {error!r}")
        seconds.append(time.monotonic() - began)


@contextlib.contextmanager
def _beside(act: Callable[[], None]) -> Iterator[None]:
    """Do something again and again in a thread."""
    stop = threading.Event()

    def run() -> None:
        while not stop.is_set():
            act()
            stop.wait(LOOK_EVERY)

    thread = threading.Thread(target=run)
    thread.start()
    try:
        yield
    finally:
        stop.set()
        thread.join()
