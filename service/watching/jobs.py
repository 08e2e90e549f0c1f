"""A worker's jobs as numbers, as lines of the log and as traces."""

import logging

from index.errors import LeaseLost
from index.jobs import Job
from service.jobs.ended import EndedJob, JobWatch, now
from service.watching.metrics import Metrics
from service.watching.spans import Spans

log = logging.getLogger(__name__)


class JobsSeen(JobWatch):
    """Tells what it hears to everyone who is configured.

    Parameters
    ----------
    metrics : Metrics
    spans : Spans
        Where traces go, or nowhere.
    lines : bool
        Whether each job gets a line of the log.
    """

    def __init__(self, metrics: Metrics, spans: Spans, *, lines: bool = False) -> None:
        self._metrics, self._spans, self._lines = metrics, spans, lines

    def claimed(self, job: Job) -> None:
        """Count how long it had waited."""
        if job.queued_at is not None:
            self._metrics.waits.observe(max((now() - job.queued_at).total_seconds(), 0.0))

    def ended(self, job: EndedJob) -> None:
        """Count its stages, write its line, send its spans."""
        for stage in _totals(job).items():
            self._metrics.stages.labels(stage[0]).observe(stage[1])
        if self._lines:
            stages = {name: round(seconds, 4) for name, seconds in _totals(job).items()}
            more = {"outcome": job.outcome, "ms": round(1000 * job.seconds, 1), "stages": stages}
            log.info("job %d ended: %s", job.job.id, job.outcome, extra={"more": more})
        self._spans.job(job)

    def lost(self, job: Job, error: Exception) -> None:  # noqa: ARG002 - as the base says
        """Count a lease that ran out; a shape that was removed is no loss."""
        if isinstance(error, LeaseLost):
            self._metrics.lost.inc()


def _totals(job: EndedJob) -> dict[str, float]:
    """Return the seconds of each stage, which may have come more than once."""
    totals: dict[str, float] = {}
    for stage in job.stages:
        totals[stage.name] = totals.get(stage.name, 0.0) + stage.seconds
    return totals
