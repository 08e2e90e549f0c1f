"""Numbers for Prometheus, one registry for each application or worker."""

from collections.abc import Iterator

from prometheus_client import CollectorRegistry, Counter, Histogram, generate_latest
from prometheus_client.core import Metric
from prometheus_client.registry import Collector

QUICK = (0.0005, 0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1, 2.5, 5, 10, 30)  # seconds
SLOW = (0.01, 0.05, 0.1, 0.25, 0.5, 1, 2.5, 5, 10, 30, 60, 300)  # seconds
WAITS = (0.1, 0.5, 1, 5, 10, 30, 60, 300, 900, 3600, 14400, 86400)  # seconds
SHARES = (0.0001, 0.001, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1)


class Metrics:
    """Counts requests, jobs and searches; docs/operating.md says what for."""

    def __init__(self) -> None:
        self.registry = CollectorRegistry()
        self.requests = self._counter("requests", "Answered requests", "method", "path", "status")
        self.latency = Histogram(
            "faience_request_seconds", "Time to the end of an answer", ("path",), registry=self.registry
        )
        self.jobs = self._counter("jobs", "Finished jobs by outcome", "outcome")
        self.job_seconds = Histogram("faience_job_seconds", "Time of a job", registry=self.registry)
        self.waits = self._histogram("job_wait_seconds", "From a job's acceptance to its claim", WAITS)
        self.stages = self._histogram("job_stage_seconds", "Time of a job's stages", SLOW, "stage")
        self.lost = self._counter("leases_lost", "Jobs that another worker took from this one")
        self.queries = self._histogram("query_seconds", "Time of a query's stages", QUICK, "method", "stage")
        self.compared = self._histogram(
            "query_compared_share", "Rows that a search compared exactly, of all", SHARES, "method"
        )
        self.escalations = self._counter(
            "query_escalations", "Searches that the first limits left with many rows", "method"
        )

    def watch(self, collector: Collector) -> None:
        """Add what is asked for at each scrape."""
        self.registry.register(collector)

    def observe_job(self, outcome: str, seconds: float) -> None:
        """Count one finished job."""
        self.jobs.labels(outcome).inc()
        self.job_seconds.observe(seconds)

    def collect(self) -> Iterator[Metric]:
        """Yield every family as it is now."""
        yield from self.registry.collect()

    def text(self) -> bytes:
        """Return everything in Prometheus' text format."""
        return generate_latest(self.registry)

    def _counter(self, name: str, words: str, *labels: str) -> Counter:
        return Counter(f"faience_{name}", words, labels, registry=self.registry)

    def _histogram(self, name: str, words: str, buckets: tuple[float, ...], *labels: str) -> Histogram:
        return Histogram(f"faience_{name}", words, labels, registry=self.registry, buckets=buckets)
