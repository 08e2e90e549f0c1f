"""Requests as spans of a trace."""

from starlette.datastructures import Headers
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from service.http.route_names import route_of, shape_of
from service.watching.context import known, known_as
from service.watching.spans import Spans


class TraceRequests:
    """ASGI middleware: a span for each request, below its caller's where it names one."""

    def __init__(self, app: ASGIApp, spans: Spans) -> None:
        self._app, self._spans = app, spans

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on inside its span."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        status = 500

        async def note(message: Message) -> None:
            nonlocal status
            if message["type"] == "http.response.start":
                status = message["status"]
            await send(message)

        with self._spans.request(dict(Headers(scope=scope))) as span, known_as(trace_id=span.trace_id):
            try:
                await self._app(scope, receive, note)
            finally:
                span.answered(f"{scope['method']} {route_of(scope)}", _attributes(scope, status))


def _attributes(scope: Scope, status: int) -> dict[str, str | int]:
    attributes: dict[str, str | int] = {
        "http.request.method": scope["method"],
        "http.route": route_of(scope),
        "http.response.status_code": status,
        "faience.request_id": str(known().get("request_id", "")),
    }
    shape_id = shape_of(scope)
    return attributes if shape_id is None else {**attributes, "faience.shape_id": shape_id}
