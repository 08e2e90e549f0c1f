"""Many uploads in the same moment, some of them of the same content."""

import threading
import time
from collections import Counter
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

from soak.parcels import kind_of, parcel
from soak.target import Target, form
from soak.wire import Reply

FIRST_PARCEL = 600_000  # as in soak.stalled
LATER = (429, 503)  # told to come back, with when
PATIENCE = 300.0  # seconds in which everyone who comes back is served


@dataclass(frozen=True, kw_only=True)
class CrowdFigures:
    """What came of it."""

    sent: int
    contents: int  # different ones among them
    answers: Mapping[int, int]  # status → how many, those that came back among them
    slowest: float  # seconds of one answer
    seconds: float


def concurrent_uploads(target: Target, count: int, *, copies: int, first: int = FIRST_PARCEL) -> CrowdFigures:
    """Send uploads at the same time; who is told to wait comes back.

    Parameters
    ----------
    count : int
        Uploads, each from a client of its own.
    copies : int
        How many of them have the same content.
    first : int
        Number of the first parcel; none from it on is known.

    Raises
    ------
    AssertionError
        An answer was none of those that are promised, or a content has no shape, or more than one.
    """
    together, start = threading.Barrier(count), time.monotonic()
    contents = [number for number in range(first, first + 2 * count) if kind_of(number) != "empty"]
    numbers = [contents[sender // copies] for sender in range(count)]  # a failed content would be new again

    def send(number: int) -> tuple[list[int], float, str]:
        body = form(parcel(number))
        together.wait()
        return _send_until_served(target, body)

    with ThreadPoolExecutor(count) as clients:
        outcomes = list(clients.map(send, numbers))
    _assert_one_shape_each(target, numbers, [shape_id for _, _, shape_id in outcomes])
    answers = Counter(status for statuses, _, _ in outcomes for status in statuses)
    assert answers[202] == len(set(numbers)), f"accepted as new: {answers[202]} of {len(set(numbers))}"
    return CrowdFigures(
        sent=count,
        contents=len(set(numbers)),
        answers=answers,
        slowest=max(slowest for _, slowest, _ in outcomes),
        seconds=time.monotonic() - start,
    )


def _send_until_served(target: Target, body: bytes) -> tuple[list[int], float, str]:
    """Return the statuses on the way to a shape, the longest time of one, and the shape's id."""
    statuses: list[int] = []
    slowest, deadline = 0.0, time.monotonic() + PATIENCE
    while True:
        start = time.monotonic()
        reply = target.upload(body)
        slowest = max(slowest, time.monotonic() - start)
        statuses.append(_promised(reply))
        if reply.status not in LATER:
            return statuses, slowest, str(reply.json()["id"])
        assert time.monotonic() < deadline, "told to come back again and again"
        time.sleep(float(reply.headers["retry-after"]))


def _promised(reply: Reply) -> int:
    assert reply.status in (200, 202, *LATER), f"{reply.status} {reply.body[:200]!r}"
    return reply.status


def _assert_one_shape_each(target: Target, numbers: list[int], ids: list[str]) -> None:
    named = Counter(shape["name"] for shape in target.shapes())
    kept = {shape["id"] for shape in target.shapes()}
    by_number: dict[int, set[str]] = {}
    for number, shape_id in zip(numbers, ids, strict=True):
        by_number.setdefault(number, set()).add(shape_id)
    for number, found in by_number.items():
        assert len(found) == named[str(number)] == 1, f"parcel {number} became {named[str(number)]} shapes"
        assert found <= kept, f"parcel {number} was acknowledged and is gone"
