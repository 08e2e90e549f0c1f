"""Numbers for Prometheus, one registry for each application."""

import time
from collections.abc import Iterator
from datetime import UTC, datetime

from prometheus_client import CollectorRegistry, Counter, Histogram, generate_latest
from prometheus_client.core import GaugeMetricFamily
from prometheus_client.registry import Collector
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from index.shapes import Status
from service.library import Library


class Metrics:
    """Counts requests and jobs."""

    def __init__(self) -> None:
        self.registry = CollectorRegistry()
        self.requests = Counter(
            "faience_requests", "Answered requests", ("method", "path", "status"), registry=self.registry
        )
        self.latency = Histogram(
            "faience_request_seconds", "Time to the end of an answer", ("path",), registry=self.registry
        )
        self.jobs = Counter("faience_jobs", "Finished jobs by outcome", ("outcome",), registry=self.registry)
        self.job_seconds = Histogram("faience_job_seconds", "Time of a job", registry=self.registry)

    def watch(self, library: Library) -> None:
        """Add what the catalogue knows, asked for at each scrape."""
        self.registry.register(_LibraryCollector(library))

    def observe_job(self, outcome: str, seconds: float) -> None:
        """Count one finished job."""
        self.jobs.labels(outcome).inc()
        self.job_seconds.observe(seconds)

    def text(self) -> bytes:
        """Return everything in Prometheus' text format."""
        return generate_latest(self.registry)


class _LibraryCollector(Collector):
    def __init__(self, library: Library) -> None:
        self._library = library

    def collect(self) -> Iterator[GaugeMetricFamily]:
        counts = self._library.catalogue.counts()
        shapes = GaugeMetricFamily("faience_shapes", "Shapes by status", labels=("status",))
        for status in Status:
            shapes.add_metric((status.value,), counts.get(status, 0))
        yield shapes
        yield GaugeMetricFamily("faience_queue_depth", "Jobs not finished", value=self._library.queue.depth())
        yield GaugeMetricFamily("faience_queue_age_seconds", "Wait of the oldest job", value=self._age())
        yield self._renewal()
        revision = self._library.catalogue.revision()
        yield GaugeMetricFamily("faience_revision", "Changes of the catalogue so far", value=revision)

    def _renewal(self) -> GaugeMetricFamily:
        gauge = GaugeMetricFamily(
            "faience_renewal_shapes", "Shapes described anew for a new version", labels=("outcome",)
        )
        progress = self._library.catalogue.renewal()
        if progress is not None:
            waiting = progress.total - progress.done - progress.failed
            outcomes = {"done": progress.done, "failed": progress.failed, "waiting": waiting}
            for outcome, number in outcomes.items():
                gauge.add_metric((outcome,), number)
        return gauge

    def _age(self) -> float:
        oldest = self._library.catalogue.progress().oldest_queued_at
        return 0.0 if oldest is None else max((datetime.now(UTC) - oldest).total_seconds(), 0.0)

    def describe(self) -> Iterator[GaugeMetricFamily]:
        return iter(())  # asked at registration: nothing is read then


class CountRequests:
    """ASGI middleware: counts every request by its route, so that ids make no new series."""

    def __init__(self, app: ASGIApp, metrics: Metrics) -> None:
        self._app, self._metrics = app, metrics

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on and note its answer."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        start, status = time.perf_counter(), 500

        async def note(message: Message) -> None:
            nonlocal status
            if message["type"] == "http.response.start":
                status = message["status"]
            await send(message)

        try:
            await self._app(scope, receive, note)
        finally:
            path = _template(scope)
            self._metrics.requests.labels(scope["method"], path, str(status)).inc()
            self._metrics.latency.labels(path).observe(time.perf_counter() - start)


def _template(scope: Scope) -> str:
    """Return the path with its parameters' names in place of their values."""
    if "route" not in scope:
        return "unknown"
    path: str = scope["path"]
    for name, value in scope.get("path_params", {}).items():
        path = path.replace(str(value), f"{{{name}}}", 1)
    return path
