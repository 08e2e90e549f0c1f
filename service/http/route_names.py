"""A request's route, so that ids make no new names."""

from starlette.types import Scope

UNKNOWN = "unknown"  # no route took the request


def route_of(scope: Scope) -> str:
    """Return the path with its parameters' names in place of their values."""
    if "route" not in scope:
        return UNKNOWN
    path: str = scope["path"]
    for name, value in scope.get("path_params", {}).items():
        path = path.replace(str(value), f"{{{name}}}", 1)
    return path


def shape_of(scope: Scope) -> str | None:
    """Return the id of the shape that a request is about, if it is about one."""
    named = scope.get("path_params", {}).get("shape_id")
    found = named or scope.get("state", {}).get("shape_id")
    return None if found is None else str(found)
