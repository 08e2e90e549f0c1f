"""Queries that are remembered for an hour: asked again, and looked at."""

from anyio import to_thread
from fastapi import APIRouter
from starlette.responses import Response

from service.asking import Question
from service.http.dependencies import LibraryPart, QuestionPart, Services, ServicesPart
from service.http.openapi import binary, problems
from service.http.reasons import ONE_QUERY, QUESTION, READING
from service.http.routes.contents import PRIVATE, WIDEST, Width, picture
from service.http.schemas import AnswerModel, RememberedModel
from service.remembering import recall, remembered_file
from service.retrieval import find_remembered
from service.storage import PREVIEW, THUMBNAIL

router = APIRouter(prefix="/queries", tags=["search"])


@router.get(
    "/{query_id}",
    operation_id="getQuery",
    summary="A remembered query",
    responses=problems(*READING, *ONE_QUERY),
)
def get_query(library: LibraryPart, query_id: str) -> RememberedModel:
    """Return what is known of a mesh that was searched for with `remember=true` within the last hour."""
    return RememberedModel.of(recall(library, query_id))


@router.get(
    "/{query_id}/similar",
    operation_id="findSimilarToQuery",
    summary="What is similar to a remembered query",
    responses=problems(*READING, *ONE_QUERY, *QUESTION),
)
async def similar(services: ServicesPart, query_id: str, question: QuestionPart) -> AnswerModel:
    """Rank the shapes by their distance to a mesh that is not kept, without describing it again."""
    return await to_thread.run_sync(_similar, services, query_id, question, limiter=services.rankings)


def _similar(services: Services, query_id: str, question: Question) -> AnswerModel:
    return AnswerModel.of(find_remembered(services.library, query_id, question))


@router.get(
    "/{query_id}/thumbnail.png",
    operation_id="getQueryThumbnail",
    summary="A picture of a remembered query",
    response_class=Response,
    responses=binary("image/png", "the picture") | problems(*READING, *ONE_QUERY),
)
def thumbnail(library: LibraryPart, query_id: str, width: Width = WIDEST) -> Response:
    """Return a picture on a transparent background."""
    return picture(remembered_file(library, query_id, THUMBNAIL), width)


@router.get(
    "/{query_id}/preview.glb",
    operation_id="getQueryPreview",
    summary="A small mesh of a remembered query, for viewers",
    response_class=Response,
    responses=binary("model/gltf-binary", "the mesh, with vertex colours") | problems(*READING, *ONE_QUERY),
)
def preview(library: LibraryPart, query_id: str) -> Response:
    """Return a small coloured mesh."""
    content = remembered_file(library, query_id, PREVIEW)
    return Response(content, media_type="model/gltf-binary", headers=PRIVATE)
