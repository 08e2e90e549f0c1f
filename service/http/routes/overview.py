"""The library at a glance: its tags, its numbers, its queue."""

from typing import Annotated

from fastapi import APIRouter, Query

from index.errors import BadCursor
from service.http.dependencies import LibraryPart
from service.http.openapi import problems
from service.http.overview_schemas import CountsModel, QueueModel, TagsModel
from service.http.reasons import READING
from service.http.routes.shapes import Cursor, Limit, TagNames, Words

router = APIRouter(tags=["overview"])

Beginning = Annotated[str | None, Query(max_length=200, description="how the tags begin")]


@router.get(
    "/tags", operation_id="listTags", summary="The tags in use", responses=problems(*READING, BadCursor)
)
def list_tags(
    library: LibraryPart, limit: Limit = 100, cursor: Cursor = None, q: Beginning = None
) -> TagsModel:
    """Return a page of the words that shapes hold in `metadata.tags`, the most used first."""
    return TagsModel.of(library.catalogue.tags(limit=limit, cursor=cursor, q=q))


@router.get(
    "/counts", operation_id="countShapes", summary="How many shapes there are", responses=problems(*READING)
)
def count_shapes(library: LibraryPart, q: Words = None, tag: TagNames = None) -> CountsModel:
    """Return how many shapes are in each state, of all or of those that the list shows with these filters."""
    return CountsModel.of(library.catalogue.counts(q=q, tags=tag or ()))


@router.get("/queue", operation_id="getQueue", summary="How far the queue is", responses=problems(*READING))
def queue(library: LibraryPart) -> QueueModel:
    """Return what waits, who works on it, how fast, and when it will be done."""
    catalogue = library.catalogue
    return QueueModel.of(catalogue.progress(), catalogue.counts(), catalogue.renewal())
