"""What routes are given. Coroutines, although none waits: FastAPI would send functions to threads."""

from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import Annotated

from anyio import CapacityLimiter
from fastapi import Depends, Query, Request
from fastapi.security import HTTPAuthorizationCredentials

from index.methods import DEFAULT_METHOD, METHODS
from service.asking import Question
from service.http.guards import bearer, check_host, check_key, check_origin, check_rate
from service.http.turnstile import Turnstile
from service.http.upload_rate import UploadRate
from service.intake.fields import read_weights
from service.jobs.describing import Describe
from service.key_ring import KeyRing
from service.library import Library
from service.watching.metrics import Metrics
from service.watching.readiness import Readiness


@dataclass(frozen=True, kw_only=True, eq=False)
class Services:
    """What the application opened at its start."""

    library: Library
    keys: KeyRing  # who may come in
    uploads: UploadRate  # and how often with a mesh
    searches: Executor  # describes meshes that are not kept
    turnstile: Turnstile  # before it
    rankings: CapacityLimiter  # threads that rank at the same time
    writings: CapacityLimiter  # threads that wait to write: those that read are never all taken
    metrics: Metrics
    readiness: Readiness
    looks: CapacityLimiter  # threads that look whether it is ready: never those that others wait for
    notify: Callable[[], None]  # tells the embedded worker, if there is one, of a new job
    retire: Callable[[], None]  # tells it to claim no more, since the service will end
    describe: Describe  # what a child does with an upload


async def services(request: Request) -> Services:
    """Return what the lifespan opened."""
    opened: Services = request.app.state.services
    return opened


async def library(request: Request) -> Library:
    """Return the open library."""
    return (await services(request)).library


async def guard(
    request: Request, credentials: Annotated[HTTPAuthorizationCredentials | None, Depends(bearer)]
) -> None:
    """Let in who holds a key that allows this, and no pages of other sites; `request.state.holder` is who."""
    if hasattr(request.state, "holder"):  # let in already: an upload is counted once
        return
    opened = await services(request)
    if not opened.keys.demanded and not opened.library.settings.insecure:
        check_host(request)
    check_origin(request)
    holder = check_key(request, credentials, opened.keys)
    check_rate(request, holder, opened.uploads)
    request.state.holder = holder


MethodName = Annotated[
    str, Query(description="a name from /v1/methods", json_schema_extra={"enum": list(METHODS)})
]
Weights = Annotated[
    str | None,
    Query(
        description="own weights, as `block:number,…` or as a JSON object; blocks left out keep theirs",
        examples=["log-hks:1,colour-histogram:0.5"],
    ),
]


async def question(
    method: MethodName = DEFAULT_METHOD,
    limit: Annotated[int, Query(ge=1, le=1000, description="results at most")] = 10,
    weights: Weights = None,
    relations: Annotated[
        bool,
        Query(description="whether to tell what each result is to the query; milliseconds more for each"),
    ] = False,
) -> Question:
    """Return how to search, from the query string."""
    return Question(method=method, limit=limit, weights=read_weights(weights), relations=relations)


ServicesPart = Annotated[Services, Depends(services)]
LibraryPart = Annotated[Library, Depends(library)]
QuestionPart = Annotated[Question, Depends(question)]
