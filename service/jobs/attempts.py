"""A job while it is computed."""

from dataclasses import dataclass, field
from datetime import datetime

from index.jobs import Job
from service.jobs.ended import now
from service.jobs.timing import Stage


@dataclass(frozen=True, kw_only=True)
class Attempt:
    """A job that is being computed."""

    job: Job
    tries: int  # submissions so far, this one included
    started: float  # by the monotonic clock
    claimed_at: datetime = field(default_factory=now)  # UTC
    stages: list[Stage] = field(default_factory=list)  # how it spent its time, once that is known
