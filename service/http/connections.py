"""What a connection may cost before, between and after its requests: uvicorn sets no clock for those."""

import asyncio
import contextlib
import sys
from http import HTTPStatus

import h11
from starlette.responses import Response
from uvicorn.protocols.http.h11_impl import H11Protocol

from service.file_limit import file_limit
from service.http.problems import plain_problem


class BoundedConnection(H11Protocol):
    """A connection that is closed when its client neither asks, nor listens, nor keeps to HTTP.

    Ways to cost a server much with little are taken away: heads that never end, bodies that go on after
    their answer, answers that nobody reads, and a thousand connections that say nothing. What is no HTTP
    is answered by a problem, as every other error.
    """

    head_seconds = 20.0  # from the first moment, or the last answer, to the end of a request's head
    deaf_seconds = 60.0  # longest time in which the client takes nothing of an answer
    linger_seconds = 2.0  # in which a refused client may read why
    most = 1000  # connections at the same time, where the process may open four times as many files

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override] # as uvicorn's
        """Start the first clock; where there are too many connections, one that is idle has to go."""
        super().connection_made(transport)
        transport.set_write_buffer_limits(0)  # so that a deaf client is noticed at the first byte
        self._refused = False
        self._head_clock: asyncio.TimerHandle | None = None
        self._deaf_clock: asyncio.TimerHandle | None = None
        self._mind_head()
        if len(self.connections) > min(self.most, file_limit() // 4):
            self._make_room()

    def connection_lost(self, exc: Exception | None) -> None:
        """Stop the clocks."""
        self._head_clock = _stopped(self._head_clock)
        self._deaf_clock = _stopped(self._deaf_clock)
        super().connection_lost(exc)

    def data_received(self, data: bytes) -> None:
        """Take what the client sends; nothing any more once it is refused."""
        if not self._refused:
            super().data_received(data)

    def handle_events(self) -> None:
        """Follow the request, and know whether a head is still awaited."""
        super().handle_events()
        self._mind_head()

    def on_response_complete(self) -> None:
        """Wait for the next request, which may be here already."""
        super().on_response_complete()
        self._mind_head()

    def pause_writing(self) -> None:
        """Wait for a client that does not read, but not for ever."""
        super().pause_writing()
        self._deaf_clock = self._deaf_clock or self.loop.call_later(self.deaf_seconds, self.transport.abort)

    def resume_writing(self) -> None:
        """Note that the client read everything so far."""
        super().resume_writing()
        self._deaf_clock = _stopped(self._deaf_clock)

    def send_400_response(self, msg: str) -> None:  # noqa: ARG002 - uvicorn's words; ours say more
        """Answer what is no HTTP; called by uvicorn while it handles h11's error."""
        hint = getattr(sys.exception(), "error_status_hint", HTTPStatus.BAD_REQUEST)
        too_long = hint == HTTPStatus.REQUEST_HEADER_FIELDS_TOO_LARGE
        self._refuse(HTTPStatus.REQUEST_HEADER_FIELDS_TOO_LARGE if too_long else HTTPStatus.BAD_REQUEST)

    @property
    def idle(self) -> bool:
        """Whether no request is being worked on."""
        return self.cycle is None or self.cycle.response_complete

    def deadline(self) -> float:
        """Return when a head must be here, by the loop's clock; infinite where none is awaited."""
        return self._head_clock.when() if self._head_clock else float("inf")

    def _mind_head(self) -> None:
        if not self.idle or self._refused:
            self._head_clock = _stopped(self._head_clock)
        elif self._head_clock is None:
            self._head_clock = self.loop.call_later(self.head_seconds, self._end_of_patience)

    def _end_of_patience(self) -> None:
        begun, _ = self.conn.trailing_data
        if begun:
            self._refuse(HTTPStatus.REQUEST_TIMEOUT)
        else:
            self.transport.close()  # browsers open connections in advance: nothing was asked

    def _make_room(self) -> None:
        """Close the connection that has waited longest for a request; this one, if all others are at work."""
        others = (each for each in self.connections if isinstance(each, BoundedConnection))
        open_ones = (each for each in others if not each.transport.is_closing())
        waiting = (each for each in open_ones if each.idle and each is not self)
        oldest = min(waiting, key=BoundedConnection.deadline, default=None)
        if oldest is None:
            self._refuse(HTTPStatus.SERVICE_UNAVAILABLE)
        else:
            oldest.transport.abort()

    def _refuse(self, status: HTTPStatus) -> None:
        """Answer without a request, if no answer is on its way already, and let the client read it."""
        if self.conn.our_state in (h11.IDLE, h11.SEND_RESPONSE):
            for event in _events(plain_problem(status), status):
                self.transport.write(self.conn.send(event) or b"")
        if self.cycle is not None:  # whoever works on the request learns that its client is gone
            self.cycle.disconnected = True
            self.cycle.message_event.set()
        self._refused = True
        self._mind_head()
        self.loop.call_later(self.linger_seconds, self.transport.abort)
        if self.transport.can_write_eof():
            with contextlib.suppress(OSError):  # the client has gone already
                self.transport.write_eof()  # closed at once, the answer would be lost with all that is unread


def _events(answer: Response, status: HTTPStatus) -> tuple[h11.Event, ...]:
    headers = [*answer.raw_headers, (b"connection", b"close")]
    head = h11.Response(status_code=status, headers=headers, reason=status.phrase.encode())
    return head, h11.Data(data=bytes(answer.body)), h11.EndOfMessage()


def _stopped(clock: asyncio.TimerHandle | None) -> asyncio.TimerHandle | None:
    if clock is not None:
        clock.cancel()
    return None
