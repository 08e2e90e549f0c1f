"""The page and the manual: files of this package, nothing from elsewhere."""

from importlib.resources import files

from fastapi import APIRouter, Request
from starlette.responses import HTMLResponse, RedirectResponse, Response

from index.errors import FileMissing
from service.http.manual import manual

router = APIRouter(include_in_schema=False)

STATIC = files("service") / "static"
TYPES = {
    "index.html": "text/html",
    "page.js": "text/javascript",
    "page.css": "text/css",
    "icon.svg": "image/svg+xml",
}


@router.get("/")
def page() -> Response:
    """Return the page."""
    return static("index.html")


@router.get("/static/{name}")
def static(name: str) -> Response:
    """Return one of the page's files."""
    if name not in TYPES:
        raise FileMissing(f"the page has no file {name!r}")
    return Response(
        (STATIC / name).read_bytes(), media_type=TYPES[name], headers={"Cache-Control": "no-cache"}
    )


@router.get("/favicon.ico")
def icon() -> Response:
    """Return the picture of the browser's tab."""
    return RedirectResponse("/static/icon.svg")


@router.get("/docs")
def docs(request: Request) -> HTMLResponse:
    """Return the interface's manual, made from its own description."""
    return HTMLResponse(manual(request.app.openapi()))
