"""Clients that stop in the middle and hold on, beside one that works."""

import contextlib
import socket
import statistics
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import cycle
from typing import ParamSpec

from soak.parcels import parcel
from soak.target import Target, form
from soak.wire import Reply

Sent = ParamSpec("Sent")

SMALL_BUFFER = 4096  # bytes that a client which does not read takes at most, more or less
FILL = 200  # answers asked for by a client that reads none: more than every buffer on the way holds
RELEASE_SECONDS = 75.0  # until all are let go of; the longest of the service's own patience is a minute
GRACE = 10.0  # seconds for what is on its way
DEAF = "answer"  # the place of a client that does not read
FIRST_PARCEL = 500_000  # of the uploads here; other parts of the soak send parcels of smaller numbers


@dataclass(frozen=True, kw_only=True)
class StallFigures:
    """What the client that worked noticed, and what became of the others."""

    stalled: Mapping[str, int]  # where they stopped → how many
    released: Mapping[str, int]  # the same → how many the service let go of in time
    calm: float  # seconds, median of a working client's request without them
    beside: float  # seconds, the same beside them

    @property
    def ratio(self) -> float:
        """How much longer a request takes beside stalled clients."""
        return self.beside / self.calm


def stalled_clients(
    target: Target, count: int, *, requests: int, release_seconds: float, first: int = FIRST_PARCEL
) -> StallFigures:
    """Stall clients in every place in turns, work beside them, then wait until they are let go of.

    Parameters
    ----------
    count : int
        Stalled clients.
    requests : int
        Uploads, and as many questions, of the working client: without the others, and again beside them.
    release_seconds : float
        After which none of them may be connected any more.
    first : int
        Number of the first parcel that is sent; none from it on is known.

    Raises
    ------
    AssertionError
        A request of the working client was not served.
    """
    calm = _work(target, range(first, first + requests))
    with contextlib.ExitStack() as open_ones:
        stalled = [
            (place, open_ones.enter_context(_stall(target, begin)))
            for (place, begin), _ in zip(cycle(PLACES.items()), range(count), strict=False)
        ]
        beside = _work(target, range(first + requests, first + 2 * requests))
        deadline = time.monotonic() + release_seconds
        released = [place for place, held in stalled if _is_let_go(place, held, deadline)]
    return StallFigures(
        stalled={place: sum(place == each for each, _ in stalled) for place in PLACES},
        released={place: released.count(place) for place in PLACES},
        calm=calm,
        beside=beside,
    )


def _in_head(target: Target) -> bytes:
    return target.head("GET", "/v1/shapes")[:20]


def _in_part_header(target: Target) -> bytes:
    return target.upload_head("Content-Length: 100000") + form({"a.ply": b""})[:40]


def _in_body(target: Target) -> bytes:
    return target.upload_head("Content-Length: 100000") + form({"a.ply": b"ply\n" * 100})[:300]


def _in_answer(target: Target) -> bytes:
    question = target.head("GET", "/openapi.json").replace(b"Connection: close\r\n", b"")
    return question * FILL


PLACES: Mapping[str, Callable[[Target], bytes]] = {
    "head": _in_head,
    "part header": _in_part_header,
    "body": _in_body,
    DEAF: _in_answer,
}


@contextlib.contextmanager
def _stall(target: Target, begin: Callable[[Target], bytes]) -> Iterator[socket.socket]:
    with socket.socket() as connection:
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, SMALL_BUFFER)
        connection.connect((target.address.host, target.address.port))
        connection.sendall(begin(target))
        yield connection


def _is_let_go(place: str, connection: socket.socket, deadline: float) -> bool:
    """Return whether the service ends a connection before the deadline."""
    if place == DEAF:  # reading would wake it: nothing is read before the deadline
        time.sleep(max(0.0, deadline - time.monotonic()))
        return _drain(connection, GRACE).count(b"HTTP/1.1 200") < FILL
    try:
        _drain(connection, max(GRACE, deadline - time.monotonic()))
    except TimeoutError:
        return False
    return True


def _drain(connection: socket.socket, patience: float) -> bytes:
    """Read until the other side ends the connection; TimeoutError where it does not."""
    connection.settimeout(patience)
    data = bytearray()
    with contextlib.suppress(ConnectionResetError):
        while piece := connection.recv(65536):
            data += piece
    return bytes(data)


def _work(target: Target, numbers: Sequence[int]) -> float:
    """Upload and ask in turns; return the median time of a request in seconds."""
    times = []
    for number in numbers:
        body = form(parcel(number))
        times += [_timed(target.upload, body), _timed(target.ask, "GET", "/v1/shapes")]
    return statistics.median(times)


def _timed(ask: Callable[Sent, Reply], *sent: Sent.args, **more: Sent.kwargs) -> float:
    start = time.perf_counter()
    reply = ask(*sent, **more)
    assert reply.status in (200, 202), f"beside stalled clients: {reply.status} {reply.body[:200]!r}"
    return time.perf_counter() - start
