"""`faience worker`: work on a library's queue, without an API."""

import signal
import threading
from typing import Annotated

import typer

from service.commands.failures import plain_failures
from service.commands.options import DATA_DIR, Cluster, DataDir, Json, Workers
from service.commands.reporting import reporter

MetricsPort = Annotated[
    int | None,
    typer.Option("--metrics-port", min=0, max=65535, help="Numbers for Prometheus; 0 takes a free port."),
]
Host = Annotated[str | None, typer.Option("--host", help="Address of the numbers.", show_default="127.0.0.1")]


def worker(
    data_dir: DataDir = DATA_DIR,
    workers: Workers = None,
    cluster: Cluster = None,
    metrics_port: MetricsPort = None,
    host: Host = None,
    json: Json = False,
) -> None:
    """Describe the meshes of the queue until stopped; unfinished ones go back to the queue."""
    with plain_failures():
        from service.commands.opening import opened, settings_for  # heavy; --help must not wait for it
        from service.commands.serve import check_address
        from service.server import run_worker

        settings = settings_for(
            data_dir, workers=workers, cluster=cluster, metrics_port=metrics_port, host=host
        )
        if settings.metrics_port is not None:
            check_address(settings.host, settings.metrics_port)
        with opened(settings, make=True):
            pass  # what is wrong with the library is said before anything starts
        stop = threading.Event()
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, lambda *_: stop.set())
        slots = max(settings.workers, 1)
        how = f"with the cluster at {settings.cluster}" if settings.cluster else f"{slots} meshes at a time"
        report = reporter(json)
        report(f"Working on the queue of {data_dir}, {how}; Ctrl-C stops.")
        run_worker(settings, slots, stop, report)
    raise typer.Exit(0)
