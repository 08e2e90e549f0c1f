"""Every request has an id, its sender's or ours: in the answer, in a problem, in the lines of the log."""

import re
import uuid

from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from service.watching.context import known_as

HEADER = "X-Request-ID"
HARMLESS = re.compile(r"[A-Za-z0-9._-]{1,64}")  # nothing that a log, a shell or a page could take amiss


class NameRequests:
    """ASGI middleware, the outermost: takes over an id that is harmless, or makes one."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on with its id, and answer with it."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        sent = Headers(scope=scope).get(HEADER, "")
        request_id = sent if HARMLESS.fullmatch(sent) else uuid.uuid4().hex

        async def sign(message: Message) -> None:
            if message["type"] == "http.response.start":
                MutableHeaders(scope=message)[HEADER] = request_id
            await send(message)

        with known_as(request_id=request_id):
            await self._app(scope, receive, sign)
