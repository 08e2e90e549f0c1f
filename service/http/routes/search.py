"""Ranked answers."""

from typing import Annotated

from anyio import to_thread
from fastapi import APIRouter, Query, Request

from index.errors import FileMissing, NotReady
from service.asking import Question
from service.http.dependencies import QuestionPart, Services, ServicesPart
from service.http.openapi import form_body, problems
from service.http.reasons import DESCRIBING, ONE_SHAPE, QUESTION, READING, UPLOAD
from service.http.schemas import AnswerModel
from service.intake.submissions import Submission
from service.intake.uploads import receiving
from service.retrieval import Answer, find_similar, search_upload

router = APIRouter(tags=["search"])

Remember = Annotated[
    bool,
    Query(description="keep what was described for an hour, for `/v1/queries`"),
]


@router.get(
    "/shapes/{shape_id}/similar",
    operation_id="findSimilar",
    summary="What is similar to a stored shape",
    responses=problems(*READING, *ONE_SHAPE, *QUESTION, FileMissing, NotReady),
)
async def similar(services: ServicesPart, shape_id: str, question: QuestionPart) -> AnswerModel:
    """Rank the other shapes by their distance to this one."""
    return await to_thread.run_sync(_similar, services, shape_id, question, limiter=services.rankings)


def _similar(services: Services, shape_id: str, question: Question) -> AnswerModel:
    return AnswerModel.of(find_similar(services.library, shape_id, question))


@router.post(
    "/search",
    operation_id="searchByMesh",
    summary="What is similar to a mesh that is not kept",
    responses=problems(*READING, *UPLOAD, *QUESTION, *DESCRIBING),
    openapi_extra=form_body(details=False),
)
async def search(
    request: Request, services: ServicesPart, question: QuestionPart, remember: Remember = False
) -> AnswerModel:
    """Describe a mesh, rank the shapes by their distance to it, and forget it, at once or after an hour."""
    async with receiving(request, services.library) as submission:
        answer = await to_thread.run_sync(_search, services, submission, question, remember)
    return AnswerModel.of(answer)


def _search(services: Services, submission: Submission, question: Question, remembered: bool) -> Answer:
    with services.turnstile.enter():
        return search_upload(
            services.library,
            services.searches,
            submission,
            question,
            services.describe,
            remembered=remembered,
        )
