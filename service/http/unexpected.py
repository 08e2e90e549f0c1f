"""What nobody expected leaves as a problem, with the headers of every other answer."""

from starlette.requests import Request
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from service.http.errors import unexpected


class AnswerUnexpected:
    """ASGI middleware, the innermost: Starlette's own answer to defects would pass by all the others."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on; answer for it where it fails before it has said anything."""
        started = False

        async def note(message: Message) -> None:
            nonlocal started
            started = started or message["type"] == "http.response.start"
            await send(message)

        try:
            await self._app(scope, receive, note)
        except Exception as error:
            if started or scope["type"] != "http":
                raise  # the server cuts the connection: nobody takes the part for the whole
            await unexpected(Request(scope), error)(scope, receive, send)
