"""The queue: jobs are claimed once, leased, and given up after too many attempts."""

from collections.abc import Callable
from datetime import datetime, timedelta

from sqlalchemy import ColumnElement, Engine, and_, func, or_, select, update
from sqlalchemy.orm import Session

from index.claiming import Kind, any_waits, job_of, kinds, take_oldest
from index.database import reading, writing
from index.deliveries import announce
from index.errors import LeaseLost
from index.jobs import MAX_ATTEMPTS, Job, end_row, held_row
from index.renewed import keep_failure
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
        self._flows = False  # whether the last claim found a job

    def claim(self, worker: str, lease_seconds: float, fingerprint: str | None = None) -> Job | None:
        """Take the oldest job that nobody holds, or whose lease ran out; None where there is none.

        The shape of an upload becomes `processing` in the same transaction. A job whose attempts are used
        up is not taken: its shape becomes `failed` with the code ``gave_up``. Shapes to be described anew
        come after all uploads; they stay `ready`, also where that fails.

        Parameters
        ----------
        fingerprint : str, optional
            Of the parameters that this worker describes with; shapes are described anew only for these.
        """
        moment = self._clock()
        # who asks an empty queue again and again must lock nobody out; where a job was, another likely is
        if not self._flows and not self._waits(moment, fingerprint):
            return None
        until = moment + timedelta(seconds=lease_seconds)
        found = (self._take(kind, moment, worker, until, fingerprint) for kind in kinds(fingerprint))
        job = next((job for job in found if job is not None), None)
        self._flows = job is not None
        return job

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
            if row.fingerprint is None:
                _set_status(session, row.shape_id, Status.QUEUED)

    def depth(self) -> int:
        """Return how many uploads wait for a worker."""
        with reading(self._engine) as session:
            query = select(func.count()).select_from(JobRow).where(_free(self._clock()), _for(None))
            return session.scalars(query).one()

    def _waits(self, moment: datetime, fingerprint: str | None) -> bool:
        with reading(self._engine) as session:
            return any_waits(session, moment, fingerprint)

    def _take(
        self, kind: Kind, moment: datetime, worker: str, until: datetime, fingerprint: str | None
    ) -> Job | None:
        while True:
            with writing(self._engine) as session:
                job = take_oldest(session, kind, moment, worker, until, fingerprint)
            if job is None or job.attempts <= MAX_ATTEMPTS:
                return job
            with writing(self._engine) as session:
                lock_state(session)
                _give_up_exhausted(session, moment)


def _free(moment: datetime) -> ColumnElement[bool]:
    return or_(JobRow.lease_until.is_(None), JobRow.lease_until < moment)


def _for(fingerprint: str | None) -> ColumnElement[bool]:
    upload = JobRow.fingerprint.is_(None)
    return upload if fingerprint is None else or_(upload, JobRow.fingerprint == fingerprint)


def _give_up_exhausted(session: Session, moment: datetime) -> None:
    exhausted = and_(_free(moment), JobRow.attempts >= MAX_ATTEMPTS)
    for row in session.scalars(select(JobRow).where(exhausted)).all():
        detail = f"{row.attempts} attempts ended without a result"
        if row.fingerprint is None:
            shape = shape_row(session, row.shape_id)
            shape.status, shape.error_code, shape.error_detail = Status.FAILED, "gave_up", detail
            touch(session, shape)
            announce(session, shape.id, Status.FAILED, shape.updated_at)
        else:
            keep_failure(session, row.shape_id, row.fingerprint, "gave_up", detail)
        end_row(session, row, "gave_up", moment)


def _set_status(session: Session, shape_id: str, status: Status) -> None:
    row = shape_row(session, shape_id)
    row.status = status
    touch(session, row)
