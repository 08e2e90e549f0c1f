"""The web application: made from settings, opened and closed by its lifespan."""

import contextlib
import os
import threading
from collections.abc import AsyncIterator, Callable, Iterator
from importlib.metadata import version

from anyio import CapacityLimiter, to_thread
from fastapi import APIRouter, Depends, FastAPI

from index.keys import Keys
from index.rehearsal import rehearse as rehearse_search
from service.http.dependencies import Services, guard
from service.http.errors import add_handlers
from service.http.head import AnswerHead
from service.http.headers import AddSafeHeaders
from service.http.metrics import CountRequests, Metrics
from service.http.openapi import DESCRIPTION, GUARDED, SUMMARY, describe_interface
from service.http.plain_errors import ReplacePlainErrors
from service.http.routes import (
    contents,
    duplicates,
    events,
    health,
    methods,
    overview,
    page,
    queries,
    search,
    shapes,
    why,
)
from service.http.slow_bodies import LimitBodyTime
from service.http.turnstile import Turnstile
from service.http.unexpected import AnswerUnexpected
from service.http.upload_rate import UploadRate
from service.jobs.describing import Describe, describe_files
from service.jobs.executors import child_limits, start_computing
from service.jobs.pool import ProcessPerJob
from service.jobs.workers import Worker, process_name
from service.key_ring import KeyRing
from service.library import Library
from service.refining import rehearse as rehearse_registration
from service.relations.postures import rehearse as rehearse_postures
from service.settings import Settings
from service.why.sides import rehearse as rehearse_why

OpenLibrary = Callable[[Settings], Library]
RANKINGS = 2 * (os.cpu_count() or 1)  # threads that rank: more would only take turns
WRITINGS = 16  # threads that write: a catalogue that another process locks makes all of them wait


def create_app(
    settings: Settings, *, open_library: OpenLibrary = Library.open, describe: Describe = describe_files
) -> FastAPI:
    """Return the application; nothing is opened before it starts.

    Parameters
    ----------
    settings : Settings
        With ``workers`` above 0 the application also works on the queue, in processes of its own.
    open_library : callable
        Opens what the settings name.
    describe : callable
        What a child process does with an upload; importable by name.
    """
    metrics = Metrics()

    @contextlib.asynccontextmanager
    async def lifespan(app: FastAPI) -> AsyncIterator[None]:
        opened = _services(settings, metrics, open_library, describe)
        app.state.services = await to_thread.run_sync(opened.__enter__)
        try:
            yield
        finally:
            await to_thread.run_sync(opened.__exit__, None, None, None)

    app = FastAPI(
        title="Faience",
        version=version("faience"),
        summary=SUMMARY,
        description=DESCRIPTION,
        lifespan=lifespan,
        docs_url=None,  # FastAPI's own pages load scripts from elsewhere; ours is in routes.page
        redoc_url=None,
    )
    app.add_middleware(LimitBodyTime, idle_seconds=settings.body_idle_seconds, seconds=settings.body_seconds)
    app.add_middleware(AnswerUnexpected)
    app.add_middleware(AnswerHead)
    app.add_middleware(ReplacePlainErrors)
    app.add_middleware(AddSafeHeaders)
    app.add_middleware(CountRequests, metrics=metrics)
    add_handlers(app)
    _add_routes(app)
    describe_interface(app)
    return app


def _add_routes(app: FastAPI) -> None:
    guarded = APIRouter(prefix="/v1", dependencies=[Depends(guard)], responses=GUARDED)
    at_a_glance = methods, overview
    # the most asked for first
    for part in (search, shapes, contents, queries, *at_a_glance, duplicates, why, events):
        guarded.include_router(part.router)
    app.include_router(guarded)
    app.include_router(health.router)
    app.include_router(page.router)


@contextlib.contextmanager
def _services(
    settings: Settings, metrics: Metrics, open_library: OpenLibrary, describe: Describe
) -> Iterator[Services]:
    """Open everything; close it in the opposite order, children killed, jobs given back."""
    with contextlib.ExitStack() as stack:
        library = open_library(settings)
        stack.callback(library.close)
        metrics.watch(library)
        keys = KeyRing(settings, Keys(library.engine).active)
        stack.enter_context(keys.watching())
        searches = ProcessPerJob(slots=settings.search_slots, limits=child_limits(settings))
        searches.warm()
        stack.callback(searches.shutdown, cancel_futures=True)
        stack.enter_context(_rehearsal())
        notify = stack.enter_context(_embedded_worker(library, metrics, describe))
        yield Services(
            library=library,
            keys=keys,
            uploads=UploadRate(settings.uploads_per_minute),
            searches=searches,
            rankings=CapacityLimiter(RANKINGS),
            writings=CapacityLimiter(WRITINGS),
            turnstile=Turnstile(settings.search_slots + settings.search_queue),
            metrics=metrics,
            notify=notify,
            describe=describe,
        )


@contextlib.contextmanager
def _rehearsal() -> Iterator[None]:
    """Make compiled functions ready beside the start, which does not wait for them; the end does."""
    thread = threading.Thread(target=_rehearse, name="rehearsal")
    thread.start()
    try:
        yield
    finally:
        thread.join()


def _rehearse() -> None:
    rehearse_registration()
    rehearse_search()
    rehearse_postures()
    rehearse_why()


@contextlib.contextmanager
def _embedded_worker(library: Library, metrics: Metrics, describe: Describe) -> Iterator[Callable[[], None]]:
    """Run a worker beside the application; yield what tells it of a new job."""
    slots = library.settings.workers
    if slots == 0:
        yield lambda: None
        return
    computing = start_computing(library.settings, slots)
    worker = Worker(
        library,
        computing.executor,
        slots=computing.slots,
        name=process_name(),
        describe=describe,
        observe=metrics.observe_job,
    )
    thread = threading.Thread(target=worker.run, name="worker")
    thread.start()
    try:
        yield worker.wake
    finally:
        worker.stop()
        thread.join()  # it gives its jobs back first, while the pool still takes what it submits
        computing.executor.shutdown(cancel_futures=True)
