"""One line of the log for each request that was answered."""

import logging
import time

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from service.http.route_names import route_of, shape_of

log = logging.getLogger(__name__)


class LogRequests:
    """ASGI middleware: writes a line at the end of each answer; no address, no query, no secret is in it."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on and note its answer."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        start, status, size = time.perf_counter(), 0, 0  # 0: the connection ended before an answer

        async def note(message: Message) -> None:
            nonlocal status, size
            if message["type"] == "http.response.start":
                status = message["status"]
            else:
                size += len(message.get("body", b""))
            await send(message)

        try:
            await self._app(scope, receive, note)
        finally:
            _write(scope, status, size, time.perf_counter() - start)


def _write(scope: Scope, status: int, size: int, seconds: float) -> None:
    route = route_of(scope)
    more: dict[str, object] = {"method": scope["method"], "route": route, "status": status}
    more |= {"ms": round(1000 * seconds, 2), "bytes": size}
    holder = scope.get("state", {}).get("holder")
    if holder is not None:
        more["key"] = holder.name
    shape_id = shape_of(scope)
    if shape_id is not None:
        more["shape_id"] = shape_id
    log.info("%s %s: %d", scope["method"], route, status, extra={"more": more})
