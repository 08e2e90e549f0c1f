"""The queue: jobs are claimed once, leased, and given up after too many attempts."""

from collections.abc import Callable
from datetime import datetime, timedelta

from sqlalchemy import ColumnElement, Engine, and_, func, or_, select, update
from sqlalchemy.orm import Session

from index.claiming import attempts_of_oldest, job_of, take_oldest
from index.database import reading, writing
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
        if self._engine.dialect.name == "sqlite" and not self._waits(moment):
            return None  # asking again and again must not lock others out, as its writers do from their start
        while True:
            with writing(self._engine) as session:
                attempts = attempts_of_oldest(session, moment)
                if attempts is None:
                    return None
                if attempts < MAX_ATTEMPTS:
                    return take_oldest(session, moment, worker, moment + timedelta(seconds=lease_seconds))
                lock_state(session)
                _give_up_exhausted(session, moment)

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
            return job_of(row)

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
            return attempts_of_oldest(session, moment) is not None


def _free(moment: datetime) -> ColumnElement[bool]:
    return or_(JobRow.lease_until.is_(None), JobRow.lease_until < moment)


def _give_up_exhausted(session: Session, moment: datetime) -> None:
    exhausted = and_(_free(moment), JobRow.attempts >= MAX_ATTEMPTS)
    for row in session.scalars(select(JobRow).where(exhausted)).all():
        shape = shape_row(session, row.shape_id)
        shape.status, shape.error_code = Status.FAILED, "gave_up"
        shape.error_detail = f"{row.attempts} attempts ended without a result"
        touch(session, shape)
        end_row(session, row, "gave_up", moment)


def _set_status(session: Session, shape_id: str, status: Status) -> None:
    row = shape_row(session, shape_id)
    row.status = status
    touch(session, row)
