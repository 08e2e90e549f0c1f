"""Server-sent events: shapes that change, in the order of the catalogue's revisions."""

import json
import re
from collections.abc import AsyncIterator, Callable
from functools import partial
from typing import Annotated, Any

import anyio
from anyio import to_thread
from fastapi import APIRouter, Header, Query, Request
from sse_starlette import EventSourceResponse, ServerSentEvent

from service.http.dependencies import ServicesPart
from service.http.openapi import problems
from service.http.reasons import READING
from service.http.schemas import ShapeModel
from service.library import Library

router = APIRouter(tags=["events"])

LOOK_EVERY = 0.5  # seconds
MOST = 10**18  # of a revision; a database holds little more
PING_EVERY = 15  # seconds, so that proxies keep the connection

STREAM: dict[int | str, dict[str, Any]] = {
    200: {"description": "the stream", "content": {"text/event-stream": {"schema": {"type": "string"}}}}
}


@router.get(
    "/events",
    operation_id="watchShapes",
    summary="Shapes changing state, as they do",
    response_class=EventSourceResponse,
    responses=STREAM | problems(*READING),
)
async def watch(
    request: Request,
    services: ServicesPart,
    last_event_id: Annotated[str | None, Header(description="sent by browsers that reconnect")] = None,
    since: Annotated[
        int | None, Query(ge=0, lt=MOST, description="a revision to start after; default: now")
    ] = None,
) -> EventSourceResponse:
    """Send `shape` (the shape) and `removed` (its id) events; the last of a batch has the revision as id."""
    start, library = since, services.library
    if last_event_id is not None and re.fullmatch(r"[0-9]{1,18}", last_event_id):
        start = int(last_event_id)
    if start is None:
        start = await to_thread.run_sync(library.catalogue.revision)
    welcome = partial(services.keys.welcomes, request.state.holder)
    return EventSourceResponse(_events(library, start, welcome), ping=PING_EVERY)


async def _events(
    library: Library, revision: int, welcome: Callable[[], bool]
) -> AsyncIterator[ServerSentEvent]:
    yield ServerSentEvent(id=str(revision))  # no event: what a client goes on from that is cut off before one
    while welcome():  # a key that is revoked hears no more
        revision, found = await to_thread.run_sync(_changes, library, revision)
        for event in found:
            yield event
        await anyio.sleep(LOOK_EVERY)


def _changes(library: Library, revision: int) -> tuple[int, list[ServerSentEvent]]:
    """Return what changed after ``revision``, and the revision to ask from next."""
    if library.catalogue.revision() == revision:
        return revision, []
    changes = library.catalogue.changes_since(revision)
    shapes = library.catalogue.get_many(changes.changed)
    events = [
        ServerSentEvent(ShapeModel.of(shapes[shape_id]).model_dump_json(), event="shape")
        for shape_id in changes.changed
        if shape_id in shapes
    ]
    events += [ServerSentEvent(json.dumps({"id": shape_id}), event="removed") for shape_id in changes.removed]
    if events:  # only the last carries the id: a client cut off before it gets all of them again
        events[-1].id = str(changes.revision)
    return changes.revision, events
