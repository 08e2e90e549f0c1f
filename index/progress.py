"""Progress: how far the queue is, who works on it, and how fast."""

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime, timedelta
from statistics import median

from sqlalchemy import ColumnElement, Engine, func, select
from sqlalchemy.orm import Session

from index.database import reading
from index.jobs import REMEMBERED
from index.revisions import now
from index.tables import FinishedJobRow, JobRow

LATELY = timedelta(minutes=5)  # what is taken to go on
_SAMPLE = 1_000  # jobs of which the median is taken


@dataclass(frozen=True, kw_only=True)
class QueueProgress:
    """The queue in one moment."""

    queued: int  # uploads that nobody holds
    processing: int  # uploads that workers hold
    held: Mapping[str, int]  # worker → jobs that it holds, also those of shapes that are described anew
    oldest_queued_at: datetime | None  # UTC; None where nothing waits
    last_minute: int  # jobs that ended
    last_hour: int
    median_seconds: float | None  # of a job, from its claim to its end, in the last hour; None without any
    expected_seconds: float | None  # until the queue is empty; None where nothing ended lately


class Progress:
    """How a queue fares."""

    _engine: Engine

    def progress(self, moment: datetime | None = None) -> QueueProgress:
        """Return how far the queue is.

        Parameters
        ----------
        moment : datetime, optional
            Aware; now by default.
        """
        moment = moment or now()
        with reading(self._engine) as session:
            held, rate = _held(session, moment), _rate(session, moment)
            free = select(func.count()).select_from(JobRow).where(_free(moment))
            uploads = select(func.count()).select_from(JobRow).where(JobRow.fingerprint.is_(None))
            queued, total = session.scalars(free).one(), session.scalars(uploads).one()
            return QueueProgress(
                queued=queued,
                processing=total - queued,
                held=held,
                oldest_queued_at=_oldest(session, moment),
                last_minute=_ended(session, moment - timedelta(minutes=1)),
                last_hour=_ended(session, moment - REMEMBERED),
                median_seconds=_median_seconds(session, moment),
                expected_seconds=0.0 if not total else total / rate if rate else None,
            )


def _held(session: Session, moment: datetime) -> dict[str, int]:
    rows = session.execute(
        select(JobRow.worker, func.count())
        .where(JobRow.lease_until >= moment)
        .group_by(JobRow.worker)
        .order_by(JobRow.worker)
    )
    return {str(worker): number for worker, number in rows}


def _oldest(session: Session, moment: datetime) -> datetime | None:
    return session.scalars(select(func.min(JobRow.queued_at)).where(_free(moment))).one()


def _free(moment: datetime) -> ColumnElement[bool]:
    """Return which uploads wait; shapes that are described anew are told of by themselves."""
    free = JobRow.lease_until.is_(None) | (JobRow.lease_until < moment)
    return free & JobRow.fingerprint.is_(None)


def _ended(session: Session, since: datetime) -> int:
    query = select(func.count()).select_from(FinishedJobRow).where(FinishedJobRow.finished_at > since)
    return session.scalars(query).one()


def _median_seconds(session: Session, moment: datetime) -> float | None:
    newest = (
        select(FinishedJobRow.seconds)
        .where(FinishedJobRow.finished_at > moment - REMEMBERED)
        .order_by(FinishedJobRow.finished_at.desc())
        .limit(_SAMPLE)
    )
    seconds = session.scalars(newest).all()
    return median(seconds) if seconds else None


def _rate(session: Session, moment: datetime) -> float:
    """Return jobs a second over the last minutes, or over the shorter time since the first of them began."""
    rows = session.execute(
        select(FinishedJobRow.finished_at, FinishedJobRow.seconds).where(
            FinishedJobRow.finished_at > moment - LATELY
        )
    ).all()
    if not rows:
        return 0.0
    began = min(finished_at - timedelta(seconds=seconds) for finished_at, seconds in rows)
    span = min((moment - began).total_seconds(), LATELY.total_seconds())
    return len(rows) / max(span, 1e-3)
