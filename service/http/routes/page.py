"""The page and the manual: files of this package, nothing from elsewhere."""

from fastapi import APIRouter, Request
from starlette.responses import HTMLResponse, RedirectResponse, Response

from index.errors import FileMissing
from service.http.manual import manual
from service.http.page_files import page_files

router = APIRouter(include_in_schema=False)


@router.get("/")
def page(request: Request) -> Response:
    """Return the page."""
    return static(request, "index.html")


@router.get("/static/{name:path}")
def static(request: Request, name: str) -> Response:
    """Return one of the page's files, or that the browser's copy is still right."""
    file = page_files().get(name)
    if file is None:
        raise FileMissing(f"the page has no file {name!r}")
    headers = {"Cache-Control": "no-cache", "ETag": file.tag, "Vary": "Accept-Encoding"}
    if file.tag in request.headers.get("if-none-match", ""):
        return Response(status_code=304, headers=headers)
    if "gzip" not in request.headers.get("accept-encoding", ""):
        return Response(file.content, media_type=file.media_type, headers=headers)
    return Response(file.packed, media_type=file.media_type, headers=headers | {"Content-Encoding": "gzip"})


@router.get("/favicon.ico")
def icon() -> Response:
    """Return the picture of the browser's tab."""
    return RedirectResponse("/static/icon.svg")


@router.get("/docs")
def docs(request: Request) -> HTMLResponse:
    """Return the interface's manual, made from its own description."""
    return HTMLResponse(manual(request.app.openapi()))
