"""Run the service: the API and its worker in one process tree, until it is told to stop."""

import contextlib
import logging
import threading
import time

import uvicorn
from fastapi import FastAPI

from service.app import create_app, telling_webhooks
from service.draining import DrainingServer
from service.file_limit import raise_file_limit
from service.first_run import Report, show_samples
from service.http.connections import BoundedConnection
from service.jobs.executors import start_computing
from service.jobs.workers import Worker, process_name
from service.library import Library
from service.listening import check_listening
from service.samples import count_samples, make_samples
from service.settings import Settings
from service.watching.jobs import JobsSeen
from service.watching.logs import start_logging
from service.watching.metrics import Metrics
from service.watching.metrics_server import serving_metrics
from service.watching.spans import open_spans

log = logging.getLogger(__name__)

GRACE_SECONDS = 10  # for answers that are on their way when the service is stopped


def run_server(settings: Settings, workers: int, samples: bool, report: Report = lambda *_: None) -> None:
    """Serve until SIGINT or SIGTERM; jobs that are not finished go back to the queue.

    Parameters
    ----------
    workers : int
        Jobs at the same time; 0: none here.
    samples : bool
        Fill an empty library with the sample creatures, and report a ranked answer for one of them.
    report : callable
        Takes a line for the user.

    Raises
    ------
    UnsafeListening
        Other machines would get in without a key.
    """
    settings = settings.model_copy(update={"workers": workers})
    check_listening(settings)
    start_logging(settings.log)
    raise_file_limit()
    app = create_app(settings)
    server = DrainingServer(_config(app, settings), settings.drain_seconds, lambda: app.state.services)
    threading.Thread(target=_accompany, args=(app, server, samples, report), daemon=True).start()
    with contextlib.suppress(KeyboardInterrupt):  # uvicorn raises it again after a clean stop
        server.run()


def _config(app: FastAPI, settings: Settings) -> uvicorn.Config:
    return uvicorn.Config(
        app,
        http=BoundedConnection,
        host=settings.host,
        port=settings.port,
        timeout_graceful_shutdown=GRACE_SECONDS,
        log_config=None,
        access_log=False,
        server_header=False,
    )


def _accompany(app: FastAPI, server: uvicorn.Server, samples: bool, report: Report) -> None:
    """Say where the service is once it listens, and show the samples."""
    while not server.started:
        if server.should_exit:
            return
        time.sleep(0.05)
    for listener in server.servers:
        for socket in listener.sockets:
            host, port = socket.getsockname()[:2]
            report(f"Faience is at http://{host}:{port} (the interface is described at /docs)")
    if not samples:
        return
    try:
        show_samples(
            app.state.services.library, make_samples(), count_samples(), lambda: server.should_exit, report
        )
    except Exception:  # the samples are a courtesy; the service goes on
        log.exception("the sample library could not be made")


def run_worker(
    settings: Settings, workers: int, stop: threading.Event, report: Report = lambda *_: None
) -> None:
    """Work on a library's queue until ``stop`` is set; unfinished jobs go back to the queue.

    Parameters
    ----------
    workers : int
        Jobs at the same time.
    report : callable
        Takes a line for the user.
    """
    start_logging(settings.log)
    library = Library.open(settings)
    metrics, spans = Metrics(), open_spans()
    computing = start_computing(settings, workers)
    worker = Worker(
        library,
        computing.executor,
        slots=computing.slots,
        name=process_name(),
        observe=metrics.observe_job,
        watch=JobsSeen(metrics, spans, lines=settings.log == "json"),
    )
    thread = threading.Thread(target=worker.run, name="worker")
    thread.start()
    try:
        with telling_webhooks(library), serving_metrics(metrics, library, report):
            stop.wait()
    finally:
        worker.stop(settings.finish_seconds)
        thread.join()  # it gives its jobs back first, while the pool still takes what it submits
        computing.executor.shutdown(cancel_futures=True)
        spans.close()
        library.close()
