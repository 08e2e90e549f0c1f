"""`faience worker`: work on a library's queue, without an API."""

import signal
import threading

import typer

from service.commands.failures import plain_failures
from service.commands.options import DATA_DIR, Cluster, DataDir, Json, Workers
from service.commands.reporting import reporter


def worker(
    data_dir: DataDir = DATA_DIR, workers: Workers = None, cluster: Cluster = None, json: Json = False
) -> None:
    """Describe the meshes of the queue until stopped; unfinished ones go back to the queue."""
    with plain_failures():
        from service.commands.opening import opened, settings_for  # heavy; --help must not wait for it
        from service.server import run_worker

        settings = settings_for(data_dir, workers=workers, cluster=cluster)
        with opened(settings, make=True):
            pass  # what is wrong with the library is said before anything starts
        stop = threading.Event()
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, lambda *_: stop.set())
        slots = max(settings.workers, 1)
        how = f"with the cluster at {settings.cluster}" if settings.cluster else f"{slots} meshes at a time"
        reporter(json)(f"Working on the queue of {data_dir}, {how}; Ctrl-C stops.")
        run_worker(settings, slots, stop)
    raise typer.Exit(0)
