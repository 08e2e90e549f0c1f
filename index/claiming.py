"""Taking the oldest free job, in as few statements as can be: each waits for the database's answer.

The statements are made once and have no objects behind their rows, which would cost more than they do.
"""

from datetime import datetime
from enum import Enum
from typing import Any
from uuid import uuid4

from sqlalchemy import ColumnElement, Row, bindparam, or_, select, update
from sqlalchemy.orm import Session
from sqlalchemy.sql.dml import ReturningUpdate

from index.errors import LeaseLost
from index.jobs import MAX_ATTEMPTS, Job
from index.shapes import Status
from index.tables import JobRow, ShapeRow, StateRow, UtcDateTime

_JOBS, _SHAPES, _STATE = (row.metadata.tables[row.__tablename__] for row in (JobRow, ShapeRow, StateRow))
_MOMENT = bindparam("moment", type_=UtcDateTime())
_FREE = or_(_JOBS.c.lease_until.is_(None), _JOBS.c.lease_until < _MOMENT)


class Kind(Enum):
    """What a job is for; all of the first come before any of the second."""

    UPLOAD = "upload"
    RENEWAL = "renewal"  # a ready shape is described anew, for the parameters with the fingerprint ``mine``


_OF: dict[Kind, ColumnElement[bool]] = {
    Kind.UPLOAD: _JOBS.c.fingerprint.is_(None),
    Kind.RENEWAL: _JOBS.c.fingerprint == bindparam("mine"),
}
_WAITS = {kind: select(_JOBS.c.id).where(_FREE, those).limit(1) for kind, those in _OF.items()}


def _take(those: ColumnElement[bool]) -> ReturningUpdate[Any]:
    oldest = (
        select(_JOBS.c.id)
        .where(_FREE, those)
        .order_by(_JOBS.c.id)
        .limit(1)
        .with_for_update(skip_locked=True)  # SQLite has one writer and leaves this out
        .scalar_subquery()
    )
    # One statement finds and takes: two workers that first looked and then took would double jobs.
    return (
        update(_JOBS)
        .where(_JOBS.c.id == oldest)
        .values(
            worker=bindparam("by"),
            token=bindparam("proof"),
            claimed_at=_MOMENT,
            lease_until=bindparam("until", type_=UtcDateTime()),
            attempts=_JOBS.c.attempts + 1,
        )
        .returning(*_JOBS.c)
    )


_TAKE = {kind: _take(those) for kind, those in _OF.items()}
_NEXT_REVISION = update(_STATE).values(revision=_STATE.c.revision + 1).returning(_STATE.c.revision)
_PROCESSING = (
    update(_SHAPES)
    .where(_SHAPES.c.id == bindparam("shape"))
    .values(status=Status.PROCESSING, revision=bindparam("number"), updated_at=_MOMENT)
)


def kinds(fingerprint: str | None) -> tuple[Kind, ...]:
    """Return what may be claimed, in its order; described anew are shapes for a fingerprint alone."""
    return (Kind.UPLOAD,) if fingerprint is None else (Kind.UPLOAD, Kind.RENEWAL)


def any_waits(session: Session, moment: datetime, fingerprint: str | None) -> bool:
    """Return whether a job is free, also one that was tried too often."""
    looks = ((_WAITS[kind], {"moment": moment, **_mine(kind, fingerprint)}) for kind in kinds(fingerprint))
    return any(session.connection().execute(*look).first() is not None for look in looks)


def take_oldest(
    session: Session,
    kind: Kind,
    moment: datetime,
    worker: str,
    lease_until: datetime,
    fingerprint: str | None,
) -> Job | None:
    """Take the oldest free job of a kind; an upload's shape is `processing` then.

    None where no job is free. A job that was tried too often comes back with more attempts than may be, and
    is not taken; in both cases nothing was changed.
    """
    connection = session.connection()
    # locks the state, as every change does first; a renewal changes nothing that anybody sees
    revision = connection.execute(_NEXT_REVISION).scalar_one()
    values = {"moment": moment, "by": worker, "proof": uuid4().hex, "until": lease_until}
    row = connection.execute(_TAKE[kind], values | _mine(kind, fingerprint)).one_or_none()
    if row is None or row.attempts > MAX_ATTEMPTS:
        session.rollback()  # nothing changed, and the revision says so
        return None if row is None else job_of(row)
    if kind is Kind.UPLOAD:
        connection.execute(_PROCESSING, {"shape": row.shape_id, "number": revision, "moment": moment})
    return job_of(row)


def _mine(kind: Kind, fingerprint: str | None) -> dict[str, str | None]:
    return {"mine": fingerprint} if kind is Kind.RENEWAL else {}


def job_of(row: JobRow | Row[Any]) -> Job:
    """Return the value of a row that somebody holds; LeaseLost otherwise."""
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
        fingerprint=row.fingerprint,
    )
