"""A query's stages as numbers and as spans."""

import contextlib
import time
from collections.abc import Iterator

from index.watch import Watch
from service.watching.metrics import Metrics
from service.watching.spans import Spans


class QueriesSeen(Watch):
    """Tells what it hears of searches."""

    def __init__(self, metrics: Metrics, spans: Spans) -> None:
        self._metrics, self._spans = metrics, spans

    @contextlib.contextmanager
    def stage(self, name: str, method: str) -> Iterator[None]:
        """Time the block."""
        start = time.perf_counter()
        try:
            with self._spans.inside(name, {"faience.method": method}):
                yield
        finally:
            self._metrics.queries.labels(method, name).observe(time.perf_counter() - start)

    def compared(self, method: str, rows: int, of: int, escalated: bool) -> None:
        """Count how much of the index a search had to read."""
        if of:
            self._metrics.compared.labels(method).observe(min(rows / of, 1.0))
        if escalated:
            self._metrics.escalations.labels(method).inc()
