"""What a worker tells of its jobs to whoever watches it."""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime

from index.jobs import Job
from service.jobs.timing import Stage

RECORDING = "recording"  # the stage after those of the description: files and rows are written


@dataclass(frozen=True, kw_only=True)
class EndedJob:
    """One claim of a job, from its beginning to its outcome."""

    job: Job
    outcome: str  # "ready", or the code of the failure
    claimed_at: datetime  # UTC
    ended_at: datetime  # UTC
    stages: Sequence[Stage]  # only the recording where the description itself failed, or nothing

    @classmethod
    def of(cls, job: Job, outcome: str, claimed_at: datetime, stages: Sequence[Stage]) -> "EndedJob":
        """Return what is known of a job that ends now."""
        return cls(job=job, outcome=outcome, claimed_at=claimed_at, ended_at=now(), stages=tuple(stages))

    @property
    def seconds(self) -> float:
        """How long this claim took."""
        return (self.ended_at - self.claimed_at).total_seconds()


class JobWatch:
    """Hears of a worker's jobs; this one does nothing with what it hears."""

    def claimed(self, job: Job) -> None:
        """Hear that a job was claimed now, for the first time or again."""

    def ended(self, job: EndedJob) -> None:
        """Hear what came of a job."""

    def lost(self, job: Job, error: Exception) -> None:
        """Hear that a job is not this worker's any more: its lease ran out, or its shape was removed."""


def now() -> datetime:
    """Return this moment, aware."""
    return datetime.now(UTC)
