"""Whether the service lives, is ready, and how it fares."""

from anyio import to_thread
from fastapi import APIRouter, Depends
from prometheus_client import CONTENT_TYPE_LATEST
from pydantic import BaseModel, Field
from starlette.responses import Response

from service.http.dependencies import ServicesPart, guard
from service.http.openapi import problems
from service.http.reasons import CATALOGUE, KEYS, READINESS

router = APIRouter(tags=["health"])


class Health(BaseModel):
    """One word."""

    status: str


class ReadyModel(Health):
    """One word for all, and some for each part."""

    parts: dict[str, str] = Field(
        description="`ok`; of the `worker`, what is known of it: it may be another process"
    )


@router.get("/livez", operation_id="live", summary="Whether the process answers", responses=problems())
def live() -> Health:
    """Answer without touching anything."""
    return Health(status="ok")


@router.get(
    "/readyz", operation_id="ready", summary="Whether requests can be served", responses=problems(*READINESS)
)
async def ready(services: ServicesPart) -> ReadyModel:
    """Look at each part, at most once a second; a process that was told to end is not ready."""
    parts = await to_thread.run_sync(services.readiness.look, limiter=services.looks)
    return ReadyModel(status="ok", parts=parts)


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
