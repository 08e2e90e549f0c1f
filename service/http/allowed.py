"""Which methods an address knows: the framework's own answer names those of one route of several."""

from http import HTTPMethod

from starlette.applications import Starlette
from starlette.requests import Request
from starlette.routing import Match


def allowed_methods(request: Request) -> str:
    """Return the methods of the request's address, as the header `Allow` lists them."""
    app: Starlette = request.app
    return ", ".join(
        method
        for method in HTTPMethod
        if any(route.matches({**request.scope, "method": method})[0] is Match.FULL for route in app.routes)
    )
