"""The web application: made from settings, opened and closed by its lifespan."""

import contextlib
import os
import threading
import time
from collections.abc import AsyncIterator, Callable, Iterator
from dataclasses import dataclass
from functools import partial
from importlib.metadata import version

from anyio import CapacityLimiter, to_thread
from fastapi import APIRouter, Depends, FastAPI
from fastapi.telemetry import TelemetryConfig

from index.keys import Keys
from index.rehearsal import rehearse as rehearse_search
from index.shapes import Shape
from service.http.access_log import LogRequests
from service.http.dependencies import Services, guard
from service.http.errors import add_handlers
from service.http.head import AnswerHead
from service.http.headers import AddSafeHeaders
from service.http.metrics import CountRequests
from service.http.openapi import DESCRIPTION, GUARDED, SUMMARY, describe_interface
from service.http.plain_errors import ReplacePlainErrors
from service.http.request_ids import NameRequests
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
from service.http.schemas import ShapeModel
from service.http.slow_bodies import LimitBodyTime
from service.http.traces import TraceRequests
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
from service.watching.checks import checks_of
from service.watching.first_load import FirstLoad
from service.watching.jobs import JobsSeen
from service.watching.library_numbers import LibraryNumbers
from service.watching.metrics import Metrics
from service.watching.queries import QueriesSeen
from service.watching.readiness import OK, Readiness
from service.watching.spans import Spans, open_spans
from service.webhooks.messenger import telling
from service.why.sides import rehearse as rehearse_why

# FastAPI's own traces would hold what was searched for, and its own log the words of exceptions.
SILENT: TelemetryConfig = {"tracing": False, "metrics": False, "logs": False, "auto_configure": False}

OpenLibrary = Callable[[Settings], Library]
RANKINGS = 2 * (os.cpu_count() or 1)  # threads that rank: more would only take turns
SILENCE = 60.0  # seconds after which a worker that does nothing is worth a word
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
    metrics, spans = Metrics(), open_spans()
    watch = JobsSeen(metrics, spans, lines=settings.log == "json")

    @contextlib.asynccontextmanager
    async def lifespan(app: FastAPI) -> AsyncIterator[None]:
        opened = _services(settings, metrics, watch, open_library, describe)
        app.state.services = await to_thread.run_sync(opened.__enter__)
        try:
            yield
        finally:
            await to_thread.run_sync(opened.__exit__, None, None, None)
            await to_thread.run_sync(spans.close)

    app = FastAPI(
        title="Faience",
        version=version("faience"),
        summary=SUMMARY,
        description=DESCRIPTION,
        lifespan=lifespan,
        docs_url=None,  # FastAPI's own pages load scripts from elsewhere; ours is in routes.page
        redoc_url=None,
        telemetry=SILENT,
    )
    app.add_middleware(LimitBodyTime, idle_seconds=settings.body_idle_seconds, seconds=settings.body_seconds)
    app.add_middleware(AnswerUnexpected)
    app.add_middleware(AnswerHead)
    app.add_middleware(ReplacePlainErrors)
    app.add_middleware(AddSafeHeaders)
    app.add_middleware(CountRequests, metrics=metrics, watch=QueriesSeen(metrics, spans))
    _watch_requests(app, settings, spans)
    add_handlers(app)
    _add_routes(app)
    describe_interface(app)
    return app


def _watch_requests(app: FastAPI, settings: Settings, spans: Spans) -> None:
    """Add what costs each request something, where it was asked for; the last is the outermost."""
    if settings.log == "json":
        app.add_middleware(LogRequests)
    if type(spans) is not Spans:
        app.add_middleware(TraceRequests, spans=spans)
    app.add_middleware(NameRequests)


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
    settings: Settings, metrics: Metrics, watch: JobsSeen, open_library: OpenLibrary, describe: Describe
) -> Iterator[Services]:
    """Open everything; close it in the opposite order, children killed, jobs given back."""
    with contextlib.ExitStack() as stack:
        library = open_library(settings)
        stack.callback(library.close)
        metrics.watch(LibraryNumbers(library))
        keys = KeyRing(settings, Keys(library.engine).active)
        stack.enter_context(keys.watching())
        searches = ProcessPerJob(slots=settings.search_slots, limits=child_limits(settings))
        searches.warm()
        stack.callback(searches.shutdown, cancel_futures=True)
        load = FirstLoad(library)
        stack.enter_context(load.running())
        stack.enter_context(_rehearsal())
        stack.enter_context(telling_webhooks(library))
        work = stack.enter_context(_embedded_worker(library, metrics, watch, describe))
        yield Services(
            library=library,
            keys=keys,
            uploads=UploadRate(settings.uploads_per_minute),
            searches=searches,
            rankings=CapacityLimiter(RANKINGS),
            writings=CapacityLimiter(WRITINGS),
            turnstile=Turnstile(settings.search_slots + settings.search_queue),
            metrics=metrics,
            readiness=Readiness(checks_of(library, keys, load), {"worker": work.told}),
            looks=CapacityLimiter(1),
            notify=work.notify,
            retire=work.retire,
            describe=describe,
        )


def telling_webhooks(library: Library) -> contextlib.AbstractContextManager[None]:
    """Return what tells webhooks of a library's shapes, as the interface shows them."""

    def read(shape_id: str) -> Shape | None:
        return library.catalogue.get_many([shape_id]).get(shape_id)

    return telling(library.engine, read, lambda shape: ShapeModel.of(shape).model_dump(mode="json"))


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


@dataclass(frozen=True, kw_only=True)
class EmbeddedWorker:
    """What the application may ask of the worker beside it."""

    notify: Callable[[], None] = lambda: None  # there is a new job
    retire: Callable[[], None] = lambda: None  # the service will end: claim no more
    told: Callable[[], str] = lambda: "is none here"  # how it fares, in words


@contextlib.contextmanager
def _embedded_worker(
    library: Library, metrics: Metrics, watch: JobsSeen, describe: Describe
) -> Iterator[EmbeddedWorker]:
    """Run a worker beside the application; yield how to speak with it."""
    settings = library.settings
    slots = settings.workers
    if slots == 0:
        yield EmbeddedWorker()
        return
    computing = start_computing(settings, slots)
    worker = Worker(
        library,
        computing.executor,
        slots=computing.slots,
        name=process_name(),
        describe=describe,
        observe=metrics.observe_job,
        watch=watch,
    )
    thread = threading.Thread(target=worker.run, name="worker")
    thread.start()
    try:
        retire = partial(_retire, worker, settings)
        yield EmbeddedWorker(notify=worker.wake, retire=retire, told=partial(_told_of, worker))
    finally:
        worker.stop(settings.finish_seconds)
        thread.join()  # it gives its jobs back first, while the pool still takes what it submits
        computing.executor.shutdown(cancel_futures=True)


def _retire(worker: Worker, settings: Settings) -> None:
    """Let a worker claim no more where that helps; otherwise jobs may still end beside the last answers."""
    if settings.finish_seconds or settings.drain_seconds:
        worker.stop(settings.finish_seconds)


def _told_of(worker: Worker) -> str:
    silent = time.monotonic() - worker.last_step
    return OK if silent < SILENCE else f"has shown no sign of life for {silent:.0f} s"
