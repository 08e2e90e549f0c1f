"""A net below the table of errors: what the framework answers in plain text leaves as a problem too."""

from http import HTTPStatus

from starlette.datastructures import Headers
from starlette.responses import Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from service.http.problems import MEDIA_TYPE, plain_problem


class ReplacePlainErrors:
    """ASGI middleware: replaces error answers of another media type (body limits, byte ranges)."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on and look at how its answer starts."""
        replaced = False

        async def replace(message: Message) -> None:
            nonlocal replaced
            if message["type"] == "http.response.start" and _plain_error(message):
                replaced = True
                await _replacement(message)(scope, receive, send)
            elif not replaced:
                await send(message)

        await self._app(scope, receive, replace)


def _plain_error(message: Message) -> bool:
    kind = Headers(scope=message).get("content-type", "")
    return message["status"] >= HTTPStatus.BAD_REQUEST and not kind.startswith(MEDIA_TYPE)


def _replacement(message: Message) -> Response:
    response = plain_problem(message["status"])
    for name in ("content-range", "connection", "allow"):
        value = Headers(scope=message).get(name)
        if value is not None:
            response.headers[name] = value
    return response
