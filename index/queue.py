"""The queue: jobs are claimed once, leased, and given up after too many attempts."""

from collections.abc import Callable
from datetime import datetime, timedelta
from uuid import uuid4

from sqlalchemy import ColumnElement, Engine, and_, func, or_, select, update
from sqlalchemy.orm import Session

from index.database import reading, writing
from index.deliveries import announce
from index.errors import LeaseLost
from index.jobs import MAX_ATTEMPTS, Job, end_row, held_row
from index.revisions import lock_state, now, touch
from index.rows import shape_row
from index.shapes import Status
from index.tables import JobRow

__all__ = ["MAX_ATTEMPTS", "Job", "Queue"]


class Queue:
    """The jobs of a catalogue's database.

    Parameters
    ----------
    engine : Engine
        The catalogue's own.
    clock : callable
        Returns the present moment, aware; workers on several machines need clocks in step.
    """

    def __init__(self, engine: Engine, clock: Callable[[], datetime] = now) -> None:
        self._engine = engine
        self._clock = clock

    def claim(self, worker: str, lease_seconds: float) -> Job | None:
        """Take the oldest job that nobody holds, or whose lease ran out; None where there is none.

        Its shape becomes `processing` in the same transaction. A job whose attempts are used up is
        not taken: its shape becomes `failed` with the code ``gave_up``.
        """
        moment = self._clock()
        if not self._waits(moment):
            return None  # asking again and again must not lock others out
        with writing(self._engine) as session:
            lock_state(session)
            _give_up_exhausted(session, moment)
            row = _claim_one(session, moment, worker, moment + timedelta(seconds=lease_seconds))
            if row is None:
                return None
            _set_status(session, row.shape_id, Status.PROCESSING)
            return _job_of(row)

    def heartbeat(self, job: Job, lease_seconds: float) -> Job:
        """Lengthen the lease from now on; LeaseLost where the job is no longer this worker's."""
        statement = (
            update(JobRow)
            .where(JobRow.id == job.id, JobRow.token == job.token)
            .values(lease_until=self._clock() + timedelta(seconds=lease_seconds))
            .returning(JobRow)
        )
        with writing(self._engine) as session:
            row = session.execute(statement).scalar_one_or_none()
            if row is None:
                raise LeaseLost(f"job {job.id} is no longer held by {job.worker}")
            return _job_of(row)

    def give_back(self, job: Job) -> None:
        """Let others take the job at once; this claim does not count as an attempt."""
        with writing(self._engine) as session:
            lock_state(session)
            row = held_row(session, job)
            row.attempts -= 1
            row.lease_until = row.claimed_at = row.worker = row.token = None
            _set_status(session, row.shape_id, Status.QUEUED)

    def depth(self) -> int:
        """Return how many jobs wait for a worker."""
        with reading(self._engine) as session:
            query = select(func.count()).select_from(JobRow).where(_free(self._clock()))
            return session.scalars(query).one()

    def _waits(self, moment: datetime) -> bool:
        with reading(self._engine) as session:
            return session.scalars(select(JobRow.id).where(_free(moment)).limit(1)).first() is not None


def _free(moment: datetime) -> ColumnElement[bool]:
    return or_(JobRow.lease_until.is_(None), JobRow.lease_until < moment)


def _claim_one(session: Session, moment: datetime, worker: str, lease_until: datetime) -> JobRow | None:
    # One statement finds and takes: two workers that first looked and then took would double jobs.
    oldest = (
        select(JobRow.id)
        .where(_free(moment))
        .order_by(JobRow.id)
        .limit(1)
        .with_for_update(skip_locked=True)  # SQLite has one writer and leaves this out
        .scalar_subquery()
    )
    statement = (
        update(JobRow)
        .where(JobRow.id == oldest)
        .values(
            worker=worker,
            token=uuid4().hex,
            claimed_at=moment,
            lease_until=lease_until,
            attempts=JobRow.attempts + 1,
        )
        .returning(JobRow)
        .execution_options(synchronize_session=False)
    )
    return session.execute(statement).scalar_one_or_none()


def _give_up_exhausted(session: Session, moment: datetime) -> None:
    exhausted = and_(_free(moment), JobRow.attempts >= MAX_ATTEMPTS)
    for row in session.scalars(select(JobRow).where(exhausted)).all():
        shape = shape_row(session, row.shape_id)
        shape.status, shape.error_code = Status.FAILED, "gave_up"
        shape.error_detail = f"{row.attempts} attempts ended without a result"
        touch(session, shape)
        announce(session, shape.id, Status.FAILED, shape.updated_at)
        end_row(session, row, "gave_up", moment)


def _set_status(session: Session, shape_id: str, status: Status) -> None:
    row = shape_row(session, shape_id)
    row.status = status
    touch(session, row)


def _job_of(row: JobRow) -> Job:
    if row.lease_until is None or row.worker is None or row.token is None:
        raise LeaseLost(f"job {row.id} is held by nobody")
    return Job(
        id=row.id,
        shape_id=row.shape_id,
        queued_at=row.queued_at,
        attempts=row.attempts,
        lease_until=row.lease_until,
        worker=row.worker,
        token=row.token,
    )
