"""HEAD, which every address with GET knows: the same answer without its body."""

from starlette.types import ASGIApp, Message, Receive, Scope, Send

ONLY_START = "faience.only_start"  # in a scope: the body would cost something and is not sent
FOUND_OUT = ("route", "path_params")  # what the router notes in a scope


class AnswerHead:
    """ASGI middleware: asks for the whole answer and passes on how it starts.

    An answer that would go on for ever ends as well: its source is told that the client is gone.
    """

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on, as a GET where it is a HEAD."""
        if scope["type"] != "http" or scope["method"] != "HEAD":
            await self._app(scope, receive, send)
            return

        async def send_start(message: Message) -> None:
            if message["type"] == "http.response.start":
                await send(message)
                await send({"type": "http.response.body"})

        asked = {**scope, "method": "GET", ONLY_START: True}
        try:
            await self._app(asked, receive, send_start)
        finally:  # who counts requests looks for them in the scope that came
            scope.update({name: asked[name] for name in FOUND_OUT if name in asked})
