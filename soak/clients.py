"""Clients that upload, remove and ask all the time, whatever becomes of the service."""

import contextlib
import random
import threading
from collections.abc import Callable, Iterator

import httpx

from soak.ledger import Ledger
from soak.parcels import Parcel, parcel

BUSY = 503  # may always be answered; the client comes back
AGAIN = 0.3  # share of uploads that repeat one without an answer
PAUSE = 0.05  # seconds between two requests of a client


@contextlib.contextmanager
def clients(port: int, ledger: Ledger, seed: int, pace: float) -> Iterator[None]:
    """Run one client of each kind until the block ends.

    Parameters
    ----------
    pace : float
        Seconds between two uploads: about what describing one takes.
    """
    stop = threading.Event()
    kinds: list[tuple[Callable[[httpx.Client, Ledger, random.Random], None], float]] = [
        (upload_one, pace),
        (remove_one, 4 * pace),
        (ask_one, PAUSE),
    ]

    def go(act: Callable[[httpx.Client, Ledger, random.Random], None], pause: float, own_seed: int) -> None:
        generator = random.Random(own_seed)
        with httpx.Client(base_url=f"http://127.0.0.1:{port}", timeout=60) as client:
            while not stop.wait(pause):
                act(client, ledger, generator)

    threads = [
        threading.Thread(target=go, args=(act, pause, seed + number), name=act.__name__)
        for number, (act, pause) in enumerate(kinds)
    ]
    for thread in threads:
        thread.start()
    try:
        yield
    finally:
        stop.set()
        for thread in threads:
            thread.join()


def upload_one(client: httpx.Client, ledger: Ledger, generator: random.Random) -> None:
    """Send a new parcel, or once more one that got no answer."""
    repeated = ledger.again(generator) if generator.random() < AGAIN else None
    number = ledger.next_number() if repeated is None else repeated
    ledger.unanswer(number)
    answer = _ask(client, "POST", "/v1/shapes", files=form(parcel(number)))
    ledger.note("upload", _status(answer), frozenset({200, 202, BUSY}), _text(answer))
    if answer is not None and answer.is_success:
        ledger.acknowledge(answer.json()["id"], number)


def remove_one(client: httpx.Client, ledger: Ledger, generator: random.Random) -> None:
    """Remove a shape that was acknowledged."""
    shape_id = ledger.pick(generator)
    if shape_id is None:
        return
    ledger.remove(shape_id, told=False)
    answer = _ask(client, "DELETE", f"/v1/shapes/{shape_id}")
    ledger.note("remove", _status(answer), frozenset({204, BUSY}), _text(answer))
    if answer is not None and answer.is_success:
        ledger.remove(shape_id, told=True)


def ask_one(client: httpx.Client, ledger: Ledger, generator: random.Random) -> None:
    """Ask one of the questions that users ask."""
    shape_id = ledger.pick(generator) or "none"
    what = generator.choice(["list", "get", "similar", "similar", "search", "thumbnail.png"])
    if what == "search":
        answer = _ask(client, "POST", "/v1/search", files=form(parcel(generator.randrange(1, 6))))
    elif what == "list":
        answer = _ask(client, "GET", "/v1/shapes")
    else:
        answer = _ask(client, "GET", f"/v1/shapes/{shape_id}" + (f"/{what}" if what != "get" else ""))
    # 404 and 409: not there yet, not ready yet; 422: the child that described the query was killed.
    expected = {200, 404, 409, BUSY} | ({422} if what == "search" else set())
    ledger.note(what, _status(answer), frozenset(expected), _text(answer))


def form(files: Parcel) -> list[tuple[str, tuple[str, bytes]]]:
    """Return files as the parts of a form."""
    return [("files", (name, content)) for name, content in files.items()]


def _ask(client: httpx.Client, method: str, path: str, **more: object) -> httpx.Response | None:
    try:
        return client.request(method, path, **more)  # type: ignore[arg-type]  # the two keyword sets of above
    except httpx.TransportError:  # it was killed meanwhile
        return None


def _status(answer: httpx.Response | None) -> int | None:
    return None if answer is None else answer.status_code


def _text(answer: httpx.Response | None) -> str:
    return "" if answer is None else answer.text
