"""Routes whose guard speaks before their body is read."""

from collections.abc import Callable, Coroutine
from typing import Any

from fastapi import Request, Response
from fastapi.routing import APIRoute

from service.http.dependencies import guard
from service.http.guards import bearer


class GuardFirst(APIRoute):
    """A route with a body in JSON, which FastAPI reads, and complains about, before any dependency.

    The guard stays a dependency of every guarded route too: what is said here comes on top, so that a route
    of another class is guarded late, never open.
    """

    def get_route_handler(self) -> Callable[[Request], Coroutine[Any, Any, Response]]:
        """Return what answers a request."""
        handle = super().get_route_handler()

        async def guarded(request: Request) -> Response:
            await guard(request, await bearer(request))
            return await handle(request)

        return guarded
