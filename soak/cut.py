"""Uploads whose clients go away in the middle: nothing of them is left, and they can be sent again."""

import re
import socket
import time
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from enum import StrEnum

from soak.target import BOUNDARY, Target
from soak.wire import connected, read_reply, reset

AGAIN_EVERY = 50  # cuts after which the whole upload is sent, and removed again
AROUND = 6  # bytes before and behind each seam of a form that are all tried
PATIENCE = 60.0  # seconds for the service to notice and to tidy up
CHUNK = 300  # bytes


class Way(StrEnum):
    """How an upload is cut."""

    SHORT = "short"  # the length that is announced ends too early
    RESET = "reset"  # the connection breaks
    UNENDED = "unended"  # chunks, of which the last never comes


@dataclass(frozen=True, kw_only=True)
class CutFigures:
    """What came of it."""

    cuts: int
    answers: Mapping[str, int]  # way, status and code → how many
    again: int  # whole uploads between and after the cuts; each was accepted as new
    seconds: float


def seams(body: bytes) -> list[int]:
    """Return the offsets around every boundary and every end of headers."""
    marks = [match.start() for match in re.finditer(rf"--{BOUNDARY}|\r\n\r\n".encode(), body)]
    near = {mark + step for mark in marks for step in range(-AROUND, AROUND + 1)}
    return sorted(offset for offset in near if 0 <= offset <= last_cut(body))


def last_cut(body: bytes) -> int:
    """Return the last offset at which a form is not complete: the boundary's end may lack its new line."""
    return len(body) - 3


def cut_uploads(target: Target, body: bytes, offsets: Iterable[int], ways: Iterable[Way] = Way) -> CutFigures:
    """Cut one upload at each offset in each way.

    Parameters
    ----------
    body : bytes
        A form whose content the library does not hold.
    offsets : iterable of int
        Bytes of it that are sent.

    Raises
    ------
    AssertionError
        Something was left behind, was acknowledged, or kept a later upload out.
    """
    start, before, shapes = time.monotonic(), target.files(), _ids(target)
    answers: Counter[str] = Counter()
    cuts = again = 0
    offsets = list(offsets)
    for way in ways:
        for offset in offsets:
            answers[f"{way} {_cut(target, body[:offset], len(body), way)}"] += 1
            _await_nothing_left(target, before, f"{way} at {offset}")
            cuts += 1
            if cuts % AGAIN_EVERY == 0:
                again += _send_again(target, body)
        assert _ids(target) == shapes, f"{way}: a cut upload became a shape"
        again += _send_again(target, body)
    return CutFigures(cuts=cuts, answers=answers, again=again, seconds=time.monotonic() - start)


def _cut(target: Target, sent: bytes, whole: int, way: Way) -> str:
    """Send a part of a form; return how that was answered."""
    framing = {
        Way.SHORT: f"Content-Length: {len(sent)}",
        Way.RESET: f"Content-Length: {whole}",
        Way.UNENDED: "Transfer-Encoding: chunked",
    }
    with connected(target.address) as connection:
        connection.sendall(
            target.upload_head(framing[way]) + (_chunked(sent) if way is Way.UNENDED else sent)
        )
        if way is Way.RESET:
            reset(connection)
            return "unheard"
        if way is Way.UNENDED:
            connection.shutdown(socket.SHUT_WR)
        reply = read_reply(connection)
    assert reply.status in (None, 400), f"{way}: {reply.status} {reply.body[:200]!r}"
    return f"{reply.status} {reply.code}" if reply.status else "closed"


def _chunked(data: bytes) -> bytes:
    pieces = [data[start : start + CHUNK] for start in range(0, len(data), CHUNK)]
    return b"".join(b"%x\r\n%s\r\n" % (len(piece), piece) for piece in pieces)


def _await_nothing_left(target: Target, before: set[str], when: str) -> None:
    deadline = time.monotonic() + PATIENCE
    while left := target.files() - before:
        assert time.monotonic() < deadline, f"{when}: left behind are {sorted(left)}"
        time.sleep(0.005)


def _send_again(target: Target, body: bytes) -> int:
    """Send the whole upload, which must be new; remove it."""
    reply = target.upload(body)
    assert reply.status == 202, f"the whole upload: {reply.status} {reply.body[:200]!r}"
    removed = target.ask("DELETE", reply.headers["location"])
    assert removed.status == 204, f"removing it: {removed.status}"
    return 1


def _ids(target: Target) -> set[str]:
    return {shape["id"] for shape in target.shapes()}
