"""Jobs: work on a shape, enqueued with it and gone with its result."""

from dataclasses import dataclass
from datetime import datetime, timedelta

from sqlalchemy import delete, select
from sqlalchemy.orm import Session

from index.errors import LeaseLost
from index.revisions import now
from index.tables import FinishedJobRow, JobRow

MAX_ATTEMPTS = 3  # claims of one job before it is given up
REMEMBERED = timedelta(hours=1)  # how long it is known how fast a job was


@dataclass(frozen=True, kw_only=True)
class Job:
    """A job as its worker holds it."""

    id: int  # never given twice
    shape_id: str  # what to work on
    queued_at: datetime | None  # UTC; whatever became of earlier claims; None of an earlier version
    attempts: int  # claims so far, this one too
    lease_until: datetime  # UTC; another worker may take the job after this
    worker: str  # who holds it
    token: str  # proves that this claim is the latest one
    fingerprint: str | None = None  # to describe a ready shape anew, with these parameters; None: an upload


def enqueue(session: Session, shape_id: str, fingerprint: str | None = None) -> None:
    """Add a job, in the transaction that makes it necessary."""
    session.add(JobRow(shape_id=shape_id, attempts=0, queued_at=now(), fingerprint=fingerprint))


def held_row(session: Session, job: Job) -> JobRow:
    """Return the row of a job that is still its worker's; LeaseLost otherwise.

    A lease that ran out counts as long as nobody else took the job.
    """
    row = session.execute(
        select(JobRow).where(JobRow.id == job.id, JobRow.token == job.token)
    ).scalar_one_or_none()
    if row is None:
        raise LeaseLost(f"job {job.id} is no longer held by {job.worker}")
    return row


def end_job(session: Session, job: Job, outcome: str) -> None:
    """Remove a job that is still its worker's, and note how long it took; LeaseLost otherwise."""
    end_row(session, held_row(session, job), outcome, now())


def end_row(session: Session, row: JobRow, outcome: str, moment: datetime) -> None:
    """Remove a job and note how long its last claim took."""
    seconds = (moment - (row.claimed_at or moment)).total_seconds()
    session.delete(row)
    noted = {"finished_at": moment, "seconds": seconds, "outcome": outcome, "worker": row.worker or ""}
    session.add(FinishedJobRow(**noted))
    session.execute(delete(FinishedJobRow).where(FinishedJobRow.finished_at < moment - REMEMBERED))
