"""Taking the oldest free job, in as few statements as can be: each waits for the database's answer.

The statements are made once and have no objects behind their rows, which would cost more than they do.
"""

from datetime import datetime
from typing import Any
from uuid import uuid4

from sqlalchemy import Row, bindparam, or_, select, update
from sqlalchemy.orm import Session

from index.errors import LeaseLost
from index.jobs import MAX_ATTEMPTS, Job
from index.shapes import Status
from index.tables import JobRow, ShapeRow, StateRow, UtcDateTime

_JOBS, _SHAPES, _STATE = (row.metadata.tables[row.__tablename__] for row in (JobRow, ShapeRow, StateRow))
_MOMENT = bindparam("moment", type_=UtcDateTime())
_FREE = or_(_JOBS.c.lease_until.is_(None), _JOBS.c.lease_until < _MOMENT)

_ATTEMPTS = select(_JOBS.c.attempts).where(_FREE).order_by(_JOBS.c.id).limit(1)

_OLDEST = (
    select(_JOBS.c.id)
    .where(_FREE, _JOBS.c.attempts < MAX_ATTEMPTS)
    .order_by(_JOBS.c.id)
    .limit(1)
    .with_for_update(skip_locked=True)  # SQLite has one writer and leaves this out
    .scalar_subquery()
)
# One statement finds and takes: two workers that first looked and then took would double jobs.
_TAKE = (
    update(_JOBS)
    .where(_JOBS.c.id == _OLDEST)
    .values(
        worker=bindparam("by"),
        token=bindparam("proof"),
        claimed_at=_MOMENT,
        lease_until=bindparam("until", type_=UtcDateTime()),
        attempts=_JOBS.c.attempts + 1,
    )
    .returning(*_JOBS.c)
)
_NEXT_REVISION = update(_STATE).values(revision=_STATE.c.revision + 1).returning(_STATE.c.revision)
_PROCESSING = (
    update(_SHAPES)
    .where(_SHAPES.c.id == bindparam("shape"))
    .values(status=Status.PROCESSING, revision=bindparam("number"), updated_at=_MOMENT)
)


def attempts_of_oldest(session: Session, moment: datetime) -> int | None:
    """Return how often the oldest free job was tried; None where no job is free."""
    attempts: int | None = session.connection().execute(_ATTEMPTS, {"moment": moment}).scalar()
    return attempts


def take_oldest(session: Session, moment: datetime, worker: str, lease_until: datetime) -> Job | None:
    """Take the oldest free job that may be tried, and tell that its shape is `processing`.

    None where others were quicker; then nothing was changed.
    """
    connection = session.connection()
    revision = connection.execute(_NEXT_REVISION).scalar_one()  # locks the state, as every change does first
    values = {"moment": moment, "by": worker, "proof": uuid4().hex, "until": lease_until}
    row = connection.execute(_TAKE, values).one_or_none()
    if row is None:
        session.rollback()  # nothing changed, and the revision says so
        return None
    connection.execute(_PROCESSING, {"shape": row.shape_id, "number": revision, "moment": moment})
    return job_of(row)


def job_of(row: JobRow | Row[Any]) -> Job:
    """Return the value of a row that somebody holds; LeaseLost otherwise."""
    if row.lease_until is None or row.worker is None or row.token is None:
        raise LeaseLost(f"job {row.id} is held by nobody")
    return Job(
        id=row.id,
        shape_id=row.shape_id,
        attempts=row.attempts,
        lease_until=row.lease_until,
        worker=row.worker,
        token=row.token,
    )
