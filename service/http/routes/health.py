"""Whether the service lives, is ready, and how it fares."""

from fastapi import APIRouter, Depends
from prometheus_client import CONTENT_TYPE_LATEST
from pydantic import BaseModel
from starlette.responses import Response

from service.http.dependencies import LibraryPart, ServicesPart, guard
from service.http.openapi import problems
from service.http.reasons import CATALOGUE, KEYS

router = APIRouter(tags=["health"])


class Health(BaseModel):
    """One word."""

    status: str


@router.get("/livez", operation_id="live", summary="Whether the process answers", responses=problems())
def live() -> Health:
    """Answer without touching anything."""
    return Health(status="ok")


@router.get(
    "/readyz", operation_id="ready", summary="Whether requests can be served", responses=problems(*CATALOGUE)
)
def ready(library: LibraryPart) -> Health:
    """Ask the catalogue one question."""
    library.catalogue.revision()
    return Health(status="ok")


@router.get(
    "/metrics",
    operation_id="metrics",
    summary="Numbers for Prometheus",
    response_class=Response,
    dependencies=[Depends(guard)],
    responses=problems(*KEYS, *CATALOGUE)
    | {200: {"content": {"text/plain": {"schema": {"type": "string"}}}}},
)
def metrics(services: ServicesPart) -> Response:
    """Return counters of requests and jobs, and the state of the library."""
    return Response(services.metrics.text(), media_type=CONTENT_TYPE_LATEST)
