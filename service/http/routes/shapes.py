"""Shapes: add, list, look at, change, remove."""

from functools import partial
from typing import Annotated, Any

import anyio
from anyio import to_thread
from fastapi import APIRouter, Query, Request, Response
from pydantic import Field

from index.errors import BadCursor, NotFailed
from index.shapes import Shape, Status
from service.http.dependencies import LibraryPart, ServicesPart
from service.http.guard_first import GuardFirst
from service.http.openapi import form_body, problems
from service.http.reasons import CHANGING, DETAILS, ONE_SHAPE, READING, UPLOAD
from service.http.schemas import ShapeChange, ShapeModel, ShapesModel
from service.intake.fields import check_metadata, check_name
from service.intake.uploads import receiving
from service.library import Library
from service.retrieval import accept_upload, change_shape, remove_shape

router = APIRouter(tags=["shapes"], route_class=GuardFirst)

LONGEST_WAIT = 300  # seconds
LOOK_EVERY = 0.1  # seconds, while waiting
CHANGE_BYTES = 2**20  # of a body that changes a shape

Wait = Annotated[float, Query(ge=0, le=LONGEST_WAIT, description="seconds to wait for the shape to be ready")]
Limit = Annotated[int, Query(ge=1, le=500, description="items of a page at most")]
Cursor = Annotated[str | None, Query(description="`next_cursor` of the page before")]
Words = Annotated[str | None, Query(max_length=500, description="words in the name or in metadata's values")]

TagNames = Annotated[
    list[Annotated[str, Field(max_length=500)]] | None,
    Query(max_length=20, description="a tag that the shapes have; may be given more than once"),
]

ADDED: dict[int | str, dict[str, Any]] = {
    200: {"model": ShapeModel, "description": "the same content is known"},
    201: {"model": ShapeModel, "description": "the shape became ready within `wait` seconds"},
}


@router.post(
    "/shapes",
    operation_id="addShape",
    summary="Add a shape",
    status_code=202,
    responses=ADDED | problems(*CHANGING, *UPLOAD),
    openapi_extra=form_body(details=True),
)
async def add_shape(
    request: Request, response: Response, services: ServicesPart, wait: Wait = 0
) -> ShapeModel:
    """Keep an upload and describe it in the background.

    When the answer is 2xx, the files are durable. A mesh that can only be judged by the worker turns
    `failed` later, with the same codes.
    """
    async with receiving(request, services.library) as submission:
        shape, new = await to_thread.run_sync(
            accept_upload, services.library, submission, limiter=services.writings
        )
    request.state.shape_id = shape.id  # for the log
    if new:
        services.notify()
    shape = await _settled(services.library, shape, wait)
    response.headers["Location"] = f"/v1/shapes/{shape.id}"
    response.status_code = (201 if shape.status == Status.READY else 202) if new else 200
    return ShapeModel.of(shape)


async def _settled(library: Library, shape: Shape, seconds: float) -> Shape:
    """Return the shape as soon as it is ready or failed, or as it is after ``seconds``."""
    with anyio.move_on_after(seconds):
        while shape.status not in (Status.READY, Status.FAILED):
            await anyio.sleep(LOOK_EVERY)
            shape = await to_thread.run_sync(library.catalogue.get, shape.id)
    return shape


@router.get(
    "/shapes",
    operation_id="listShapes",
    summary="List shapes",
    responses=problems(*READING, BadCursor),
)
def list_shapes(
    library: LibraryPart,
    limit: Limit = 50,
    cursor: Cursor = None,
    status: Status | None = None,
    q: Words = None,
    tag: TagNames = None,
) -> ShapesModel:
    """Return a page of shapes, newest first."""
    page = library.catalogue.list(limit=limit, cursor=cursor, status=status, q=q, tags=tag or ())
    return ShapesModel.of(page)


@router.get(
    "/shapes/{shape_id}",
    operation_id="getShape",
    summary="One shape",
    responses=problems(*READING, *ONE_SHAPE),
)
def get_shape(library: LibraryPart, shape_id: str) -> ShapeModel:
    """Return a shape."""
    return ShapeModel.of(library.catalogue.get(shape_id))


@router.patch(
    "/shapes/{shape_id}",
    operation_id="changeShape",
    summary="Rename a shape or replace its metadata",
    responses=problems(*CHANGING, *ONE_SHAPE, *DETAILS),
    max_body_size=CHANGE_BYTES,
)
async def change(services: ServicesPart, shape_id: str, body: ShapeChange) -> ShapeModel:
    """Change what is given; leave the rest."""
    name = check_name(body.name) if body.name is not None else None
    metadata = check_metadata(body.metadata) if body.metadata is not None else None
    act = partial(change_shape, services.library, shape_id, name=name, metadata=metadata)
    return ShapeModel.of(await to_thread.run_sync(act, limiter=services.writings))


@router.post(
    "/shapes/{shape_id}/retry",
    operation_id="retryShape",
    summary="Describe a shape that failed once more",
    status_code=202,
    responses=problems(*CHANGING, *ONE_SHAPE, NotFailed),
)
async def retry(services: ServicesPart, shape_id: str) -> ShapeModel:
    """Queue it again with the files that it has: after more memory was allowed, or a defect mended."""
    act = services.library.catalogue.retry
    shape = await to_thread.run_sync(act, shape_id, limiter=services.writings)
    services.notify()
    return ShapeModel.of(shape)


@router.delete(
    "/shapes/{shape_id}",
    operation_id="removeShape",
    summary="Remove a shape and its files",
    status_code=204,
    responses=problems(*CHANGING, *ONE_SHAPE),
)
async def remove(services: ServicesPart, shape_id: str) -> None:
    """Forget a shape; its files are deleted."""
    await to_thread.run_sync(remove_shape, services.library, shape_id, limiter=services.writings)
