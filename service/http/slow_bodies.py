"""How long a client may take to send a body, whatever the call."""

import time
from http import HTTPStatus

import anyio
from starlette.exceptions import HTTPException
from starlette.types import ASGIApp, Message, Receive, Scope, Send


class SlowBody(HTTPException):
    """The body came too slowly. The framework lets through what is of its own kind."""

    code = "slow_body"

    def __init__(self, size: int) -> None:
        detail = f"the body came too slowly; {size} bytes had arrived"
        super().__init__(HTTPStatus.REQUEST_TIMEOUT, detail, headers={})


class LimitBodyTime:
    """ASGI middleware: the next piece of a body comes within a time, and the whole within another.

    Whoever reads the body gets SlowBody otherwise. Once an answer has begun, clients may be silent.

    Parameters
    ----------
    idle_seconds : float
        The longest silence.
    seconds : float
        The longest time for a whole body.
    """

    def __init__(self, app: ASGIApp, idle_seconds: float, seconds: float) -> None:
        self._app, self._idle_seconds, self._seconds = app, idle_seconds, seconds

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on with a clock on its body."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        deadline = time.monotonic() + self._seconds
        timed, size = True, 0

        async def receive_in_time() -> Message:
            nonlocal timed, size
            patience = min(self._idle_seconds, deadline - time.monotonic())
            with anyio.move_on_after(max(patience, 0) if timed else None):
                message = await receive()
                size += len(message.get("body", b""))
                timed = timed and message.get("more_body", False)
                return message
            if timed:
                raise SlowBody(size)
            return await receive()  # the answer began meanwhile

        async def note(message: Message) -> None:
            nonlocal timed
            timed = False
            await send(message)

        await self._app(scope, receive_in_time, note)
