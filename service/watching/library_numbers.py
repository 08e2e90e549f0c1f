"""What the library itself tells at each scrape: its shapes, its queue, its indexes, its disk."""

import os
from collections.abc import Iterator
from datetime import UTC, datetime

from prometheus_client.core import GaugeMetricFamily
from prometheus_client.registry import Collector

from index.deliveries import Deliveries
from index.shapes import Status
from service.library import Library


class LibraryNumbers(Collector):
    """Asks the catalogue when it is asked."""

    def __init__(self, library: Library) -> None:
        self._library = library

    def collect(self) -> Iterator[GaugeMetricFamily]:
        """Yield the numbers of this moment."""
        yield from self._of_shapes()
        yield from self._of_queue()
        yield from self._of_renewal()
        yield from self._of_indexes()
        yield from self._of_disk()

    def describe(self) -> Iterator[GaugeMetricFamily]:
        """Yield nothing: this is asked at registration, and nothing is read then."""
        return iter(())

    def _of_shapes(self) -> Iterator[GaugeMetricFamily]:
        counts = self._library.catalogue.counts()
        shapes = GaugeMetricFamily("faience_shapes", "Shapes by status", labels=("status",))
        for status in Status:
            shapes.add_metric((status.value,), counts.get(status, 0))
        yield shapes

    def _of_queue(self) -> Iterator[GaugeMetricFamily]:
        progress = self._library.catalogue.progress()
        oldest = progress.oldest_queued_at
        age = 0.0 if oldest is None else max((datetime.now(UTC) - oldest).total_seconds(), 0.0)
        yield GaugeMetricFamily("faience_queue_depth", "Jobs not finished", value=self._library.queue.depth())
        yield GaugeMetricFamily("faience_queue_age_seconds", "Wait of the oldest job", value=age)
        held = sum(progress.held.values())
        yield GaugeMetricFamily("faience_jobs_held", "Jobs that a worker has claimed", value=held)
        untold = Deliveries(self._library.engine).waiting()
        yield GaugeMetricFamily("faience_deliveries_waiting", "Messages to webhooks", value=untold)
        workers = len(progress.held)
        yield GaugeMetricFamily("faience_workers_busy", "Workers that hold a job", value=workers)

    def _of_renewal(self) -> Iterator[GaugeMetricFamily]:
        gauge = GaugeMetricFamily(
            "faience_renewal_shapes", "Shapes described anew for a new version", labels=("outcome",)
        )
        progress = self._library.catalogue.renewal()
        if progress is not None:
            waiting = progress.total - progress.done - progress.failed
            outcomes = {"done": progress.done, "failed": progress.failed, "waiting": waiting}
            for outcome, number in outcomes.items():
                gauge.add_metric((outcome,), number)
        yield gauge

    def _of_indexes(self) -> Iterator[GaugeMetricFamily]:
        shown = self._library.searcher.revisions()  # before the catalogue's: a lag is never below zero
        revision = self._library.catalogue.revision()
        yield GaugeMetricFamily("faience_revision", "Changes of the catalogue so far", value=revision)
        lag = GaugeMetricFamily(
            "faience_index_lag_revisions", "Changes that a loaded index does not show yet", labels=("method",)
        )
        for method, at in sorted(shown.items()):
            lag.add_metric((method,), max(revision - at, 0))
        yield lag

    def _of_disk(self) -> Iterator[GaugeMetricFamily]:
        disk = os.statvfs(self._library.settings.data_dir)
        free = disk.f_bavail * disk.f_frsize
        yield GaugeMetricFamily("faience_disk_free_bytes", "Free space beside the library", value=free)
        yield GaugeMetricFamily(
            "faience_disk_free_files", "Files that may still be made there", value=disk.f_favail
        )
