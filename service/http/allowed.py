"""Which methods an address knows: the framework's own answer names those of one route of several."""

from http import HTTPMethod

from starlette.applications import Starlette
from starlette.requests import Request
from starlette.routing import Match


def allowed_methods(request: Request) -> str:
    """Return the methods of the request's address, as the header `Allow` lists them."""
    app: Starlette = request.app
    found = [
        method
        for method in HTTPMethod
        if any(route.matches({**request.scope, "method": method})[0] is Match.FULL for route in app.routes)
    ]
    if HTTPMethod.GET in found and HTTPMethod.HEAD not in found:
        found.append(HTTPMethod.HEAD)  # see service.http.head
    return ", ".join(found)
