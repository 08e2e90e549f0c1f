"""Why: how much each block, and each region of two surfaces, adds to the distance of two shapes."""

from collections.abc import Callable
from functools import partial
from typing import Annotated

from anyio import to_thread
from fastapi import APIRouter, Depends
from starlette.responses import Response

from index.methods import DEFAULT_METHOD
from service.http.dependencies import MethodName, Services, ServicesPart, Weights
from service.http.openapi import problems, whole_binary
from service.http.reasons import EXPLAINING, ONE_QUERY, ONE_SHAPE, READING
from service.http.why_schemas import WhyModel
from service.intake.fields import read_weights
from service.library import Library
from service.why.asking import Explained, Which, WhyQuestion, explain_remembered, explain_stored

router = APIRouter(tags=["why"])

Explain = Callable[[Library, str, str, WhyQuestion], Explained]  # a shape's id or a query's, the other's
GLB = "model/gltf-binary"
OF_SHAPE = problems(*READING, *ONE_SHAPE, *EXPLAINING)
OF_QUERY = problems(*READING, *ONE_QUERY, *ONE_SHAPE, *EXPLAINING)
MESH = whole_binary(GLB, "the mesh of `preview.glb`, its vertices coloured by contribution")


async def why_question(method: MethodName = DEFAULT_METHOD, weights: Weights = None) -> WhyQuestion:
    """Return what is to be explained, from the query string."""
    return WhyQuestion(method=method, weights=read_weights(weights))


WhyPart = Annotated[WhyQuestion, Depends(why_question)]


@router.get(
    "/shapes/{shape_id}/why/{other}",
    operation_id="explainDistance",
    summary="What two shapes differ in",
    responses=OF_SHAPE,
)
async def why(services: ServicesPart, shape_id: str, other: str, question: WhyPart) -> WhyModel:
    """Split the distance of two shapes among the method's blocks."""
    return await _told(services, explain_stored, shape_id, other, question)


@router.get(
    "/shapes/{shape_id}/why/{other}/query.glb",
    operation_id="explainOnQuery",
    summary="Where the first of two shapes differs",
    response_class=Response,
    responses=MESH | OF_SHAPE,
)
async def why_query(services: ServicesPart, shape_id: str, other: str, question: WhyPart) -> Response:
    """Return the mesh of the first shape, coloured by what each region adds to the distance.

    From light grey (nothing) over yellow and orange to dark red (as much as `scale` says, or more).
    """
    return await _shown(services, explain_stored, shape_id, other, question, Which.QUERY)


@router.get(
    "/shapes/{shape_id}/why/{other}/result.glb",
    operation_id="explainOnResult",
    summary="Where the second of two shapes differs",
    response_class=Response,
    responses=MESH | OF_SHAPE,
)
async def why_result(services: ServicesPart, shape_id: str, other: str, question: WhyPart) -> Response:
    """Return the mesh of the second shape, coloured on the same scale as that of the first."""
    return await _shown(services, explain_stored, shape_id, other, question, Which.RESULT)


@router.get(
    "/queries/{query_id}/why/{other}",
    operation_id="explainDistanceOfQuery",
    summary="What a remembered query and a shape differ in",
    responses=OF_QUERY,
)
async def query_why(services: ServicesPart, query_id: str, other: str, question: WhyPart) -> WhyModel:
    """Split the distance of a mesh that is not kept and a shape among the method's blocks."""
    return await _told(services, explain_remembered, query_id, other, question)


@router.get(
    "/queries/{query_id}/why/{other}/query.glb",
    operation_id="explainQueryOnQuery",
    summary="Where a remembered query differs from a shape",
    response_class=Response,
    responses=MESH | OF_QUERY,
)
async def query_why_query(services: ServicesPart, query_id: str, other: str, question: WhyPart) -> Response:
    """Return the mesh of the query, coloured by what each region adds to the distance."""
    return await _shown(services, explain_remembered, query_id, other, question, Which.QUERY)


@router.get(
    "/queries/{query_id}/why/{other}/result.glb",
    operation_id="explainQueryOnResult",
    summary="Where a shape differs from a remembered query",
    response_class=Response,
    responses=MESH | OF_QUERY,
)
async def query_why_result(services: ServicesPart, query_id: str, other: str, question: WhyPart) -> Response:
    """Return the mesh of the shape, coloured on the same scale as that of the query."""
    return await _shown(services, explain_remembered, query_id, other, question, Which.RESULT)


async def _told(
    services: Services, explain: Explain, one: str, other: str, question: WhyQuestion
) -> WhyModel:
    ask = partial(explain, services.library, one, other, question)
    explained = await to_thread.run_sync(ask, limiter=services.rankings)
    return WhyModel.of(explained.explanation)


async def _shown(
    services: Services, explain: Explain, one: str, other: str, question: WhyQuestion, which: Which
) -> Response:
    def drawn() -> bytes:
        return explain(services.library, one, other, question).glb(which)

    glb = await to_thread.run_sync(drawn, limiter=services.rankings)
    return Response(glb, media_type=GLB, headers={"Cache-Control": "private, max-age=60"})
