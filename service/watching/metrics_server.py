"""The numbers of a worker that has no API: a port of their own, where one is asked for."""

import contextlib
from collections.abc import Callable, Iterator

from prometheus_client import start_http_server

from service.library import Library
from service.watching.library_numbers import LibraryNumbers
from service.watching.metrics import Metrics


@contextlib.contextmanager
def serving_metrics(metrics: Metrics, library: Library, report: Callable[[str], None]) -> Iterator[None]:
    """Serve a worker's numbers beside the block, at ``host`` and ``metrics_port`` of the library's settings.

    Parameters
    ----------
    report : callable
        Takes a line that says where.

    Raises
    ------
    OSError
        Nobody can listen there.
    """
    settings = library.settings
    if settings.metrics_port is None:
        yield
        return
    metrics.watch(LibraryNumbers(library))
    server, thread = start_http_server(settings.metrics_port, settings.host, metrics.registry)
    try:
        report(f"Numbers for Prometheus are at http://{settings.host}:{server.server_port}/metrics")
        yield
    finally:
        server.shutdown()
        server.server_close()
        thread.join()
