"""Requests as numbers."""

import time

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from index.watch import Watch, watched
from service.http.route_names import route_of
from service.watching.metrics import Metrics


class CountRequests:
    """ASGI middleware: counts every request by its route, so that ids make no new series.

    Parameters
    ----------
    metrics : Metrics
    watch : Watch
        Hears of the searches of a request.
    """

    def __init__(self, app: ASGIApp, metrics: Metrics, watch: Watch) -> None:
        self._app, self._metrics, self._watch = app, metrics, watch

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on and note its answer."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        start, status = time.perf_counter(), 500

        async def note(message: Message) -> None:
            nonlocal status
            if message["type"] == "http.response.start":
                status = message["status"]
            await send(message)

        try:
            with watched(self._watch):
                await self._app(scope, receive, note)
        finally:
            path = route_of(scope)
            self._metrics.requests.labels(scope["method"], path, str(status)).inc()
            self._metrics.latency.labels(path).observe(time.perf_counter() - start)
