"""Why: how much each block, and each region of two surfaces, adds to the distance of two shapes."""

from typing import Annotated

from anyio import to_thread
from fastapi import APIRouter, Depends
from starlette.responses import Response

from index.methods import DEFAULT_METHOD
from service.http.dependencies import MethodName, Services, ServicesPart, Weights
from service.http.openapi import problems, whole_binary
from service.http.reasons import EXPLAINING, ONE_SHAPE, READING
from service.http.why_schemas import WhyModel
from service.intake.fields import read_weights
from service.why.asking import Which, WhyQuestion, explain_stored

router = APIRouter(tags=["why"])

GLB = "model/gltf-binary"
ERRORS = problems(*READING, *ONE_SHAPE, *EXPLAINING)
MESH = whole_binary(GLB, "the mesh of `preview.glb`, its vertices coloured by contribution") | ERRORS


async def why_question(method: MethodName = DEFAULT_METHOD, weights: Weights = None) -> WhyQuestion:
    """Return what is to be explained, from the query string."""
    return WhyQuestion(method=method, weights=read_weights(weights))


WhyPart = Annotated[WhyQuestion, Depends(why_question)]


@router.get(
    "/shapes/{shape_id}/why/{other}",
    operation_id="explainDistance",
    summary="What two shapes differ in",
    responses=ERRORS,
)
async def why(services: ServicesPart, shape_id: str, other: str, question: WhyPart) -> WhyModel:
    """Split the distance of two shapes among the method's blocks."""
    return await to_thread.run_sync(_told, services, shape_id, other, question, limiter=services.rankings)


@router.get(
    "/shapes/{shape_id}/why/{other}/query.glb",
    operation_id="explainOnQuery",
    summary="Where the first of two shapes differs",
    response_class=Response,
    responses=MESH,
)
async def why_query(services: ServicesPart, shape_id: str, other: str, question: WhyPart) -> Response:
    """Return the mesh of the first shape, coloured by what each region adds to the distance.

    From light grey (nothing) over yellow and orange to dark red (as much as `scale` says, or more).
    """
    asked = (services, shape_id, other, question, Which.QUERY)
    return await to_thread.run_sync(_shown, *asked, limiter=services.rankings)


@router.get(
    "/shapes/{shape_id}/why/{other}/result.glb",
    operation_id="explainOnResult",
    summary="Where the second of two shapes differs",
    response_class=Response,
    responses=MESH,
)
async def why_result(services: ServicesPart, shape_id: str, other: str, question: WhyPart) -> Response:
    """Return the mesh of the second shape, coloured on the same scale as that of the first."""
    asked = (services, shape_id, other, question, Which.RESULT)
    return await to_thread.run_sync(_shown, *asked, limiter=services.rankings)


def _told(services: Services, shape_id: str, other: str, question: WhyQuestion) -> WhyModel:
    return WhyModel.of(explain_stored(services.library, shape_id, other, question).explanation)


def _shown(services: Services, shape_id: str, other: str, question: WhyQuestion, which: Which) -> Response:
    glb = explain_stored(services.library, shape_id, other, question).glb(which)
    return Response(glb, media_type=GLB, headers={"Cache-Control": "private, max-age=60"})
