"""Renewals: all shapes are described anew, by other parameters, while the earlier descriptions answer.

1. `begin_renewal` names the next vocabulary. Nothing else changes: searches use the active one.
2. `queue_renewals` adds jobs for ready shapes, behind all uploads. What comes of one is stored beside the
   earlier description: blocks by fingerprint, files in a folder of that name, the facts in `renewals`.
3. `finish_renewal` makes the next vocabulary the active one when every ready shape has an outcome: one
   transaction, small, since nothing is copied. A shape without a new description becomes `failed`.
4. `forget_earlier` deletes what the earlier parameters made, a few shapes at a time.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy.typing as npt
from sqlalchemy import ColumnElement, Engine, Select, delete, exists, func, select, update
from sqlalchemy.orm import Session

from index.blocks import checked_blocks
from index.database import reading, writing
from index.descriptions import check_vocabulary, checked_quantised, known_vocabulary
from index.errors import LeaseLost
from index.jobs import Job, end_job, enqueue
from index.renewed import keep_failure, keep_renewal
from index.revisions import lock_state, next_revision, now
from index.rows import shape_of, shape_row
from index.shapes import Shape, Status
from index.stored_blocks import delete_blocks, write_plain, write_quantised
from index.stored_vocabularies import add_row
from index.tables import JobRow, RenewalRow, ShapeRow, StateRow, VocabularyRow
from index.vocabulary import Vocabulary

_ready: ColumnElement[bool] = ShapeRow.status == Status.READY


@dataclass(frozen=True, kw_only=True)
class RenewalProgress:
    """How far it is."""

    fingerprint: str  # of the parameters that shapes are described with
    done: int  # ready shapes that have a description by these
    failed: int  # ready shapes that cannot get one; they answer as before until the end
    total: int  # ready shapes


@dataclass(frozen=True, kw_only=True)
class Outdated:
    """A shape with remains of parameters that are not active any more."""

    id: str
    folders: tuple[str | None, ...]  # of its files that are needed; None: those in no folder


class Renewals:
    """How a library comes to the descriptions of a new version."""

    _engine: Engine

    def begin_renewal(self, vocabulary: Vocabulary) -> None:
        """Let all shapes be described anew for a vocabulary; an earlier beginning for another is given up."""
        with writing(self._engine) as session:
            state = lock_state(session)
            add_row(session, vocabulary)
            session.flush()
            state.next_vocabulary_id = vocabulary.id
            next_revision(session)
            others = JobRow.fingerprint.is_not(None), JobRow.fingerprint != vocabulary.fingerprint
            session.execute(delete(JobRow).where(*others))

    def queue_renewals(self, limit: int) -> int:
        """Queue up to `limit` ready shapes that have no outcome yet and no job; return how many."""
        if not self._unfinished(waiting=False):
            return 0  # asking again and again must not lock others out
        with writing(self._engine) as session:
            fingerprint = _next_fingerprint(session, lock_state(session))
            if fingerprint is None:
                return 0
            query = _unfinished(fingerprint, waiting=False).order_by(ShapeRow.id).limit(limit)
            found = session.scalars(query).all()
            for shape_id in found:
                enqueue(session, shape_id, fingerprint)
            return len(found)

    def record_renewed(
        self,
        job: Job,
        *,
        facts: Mapping[str, Any],
        fingerprint: str,
        blocks: Mapping[str, npt.ArrayLike],
        quantised: Mapping[str, npt.ArrayLike],
        vocabulary_id: str,
    ) -> Shape:
        """Store a description beside the earlier one and end the job; see `Catalogue.record_ready`.

        Raises
        ------
        LeaseLost, VocabularyChanged, FingerprintMismatch, BadBlock
        """
        plain, words = checked_blocks(blocks), checked_quantised(quantised)
        with writing(self._engine) as session:
            state = lock_state(session)
            row = _renewing(session, job)
            check_vocabulary(session, state, vocabulary_id, fingerprint)
            write_plain(session, row.id, fingerprint, plain)
            write_quantised(session, row.id, vocabulary_id, words)
            keep_renewal(session, row.id, fingerprint, facts)
            row.revision = next_revision(session)  # whoever searches among what is described anew hears of it
            return shape_of(row)

    def record_not_renewed(self, job: Job, *, code: str, detail: str) -> None:
        """Note why there is no new description and end the job; LeaseLost as for `record_renewed`."""
        with writing(self._engine) as session:
            lock_state(session)
            row = _renewing(session, job, code)
            keep_failure(session, row.id, str(job.fingerprint), code, detail)

    def finish_renewal(self) -> bool:
        """Make the next vocabulary the active one, with the descriptions by its parameters, for all at once.

        Returns
        -------
        bool
            False, and nothing is changed, while a ready shape has no outcome or nothing is under way. True
            afterwards: every index is built anew. Shapes that could not be described anew are `failed`.
        """
        if self._unfinished(waiting=True):
            return False
        with writing(self._engine) as session:
            state = lock_state(session)
            fingerprint = _next_fingerprint(session, state)
            if fingerprint is None or session.scalars(_unfinished(fingerprint).limit(1)).first() is not None:
                return False
            state.vocabulary_id, state.next_vocabulary_id = state.next_vocabulary_id, None
            state.epoch += 1
            revision = next_revision(session)
            session.execute(delete(JobRow).where(JobRow.fingerprint.is_not(None)))
            _take_over(session, fingerprint)
            _fail(session, fingerprint, revision)
            return True

    def renewal(self) -> RenewalProgress | None:
        """Return how far it is; None where nothing is under way."""
        with reading(self._engine) as session:
            fingerprint = _next_fingerprint(session, session.scalars(select(StateRow)).one())
            if fingerprint is None:
                return None
            outcome = (RenewalRow.fingerprint == fingerprint, RenewalRow.shape_id == ShapeRow.id, _ready)
            failed = _count(session, select(ShapeRow.id).where(*outcome, RenewalRow.facts.is_(None)))
            undone = _count(session, _unfinished(fingerprint))
            total = _count(session, select(ShapeRow.id).where(_ready))
            return RenewalProgress(
                fingerprint=fingerprint, done=total - undone - failed, failed=failed, total=total
            )

    def outdated(self, limit: int) -> list[Outdated]:
        """Return up to `limit` shapes with remains of parameters that are neither active nor the next."""
        with reading(self._engine) as session:
            upcoming = _next_fingerprint(session, session.scalars(select(StateRow)).one())
            query = _outdated(upcoming, limit)
            kept = () if upcoming is None else (upcoming,)
            return [
                Outdated(id=row.id, folders=(row.made_in, *kept))
                for row in session.scalars(select(ShapeRow).where(ShapeRow.id.in_(query)))
            ]

    def forget_earlier(self, shape_ids: Sequence[str]) -> None:
        """Delete these shapes' blocks of parameters that are neither active nor the next."""
        with writing(self._engine) as session:
            state = lock_state(session)
            upcoming = _next_fingerprint(session, state)
            used = [known_vocabulary(session, str(state.vocabulary_id)).fingerprint]
            used += [] if upcoming is None else [upcoming]
            for shape_id in shape_ids:
                delete_blocks(session, shape_id, used)
            gone = _outdated_rows(upcoming), RenewalRow.shape_id.in_(shape_ids)
            session.execute(delete(RenewalRow).where(*gone))

    def _unfinished(self, *, waiting: bool) -> bool:
        """Tell whether a shape has no outcome; with ``waiting``, shapes whose jobs are queued count too."""
        with reading(self._engine) as session:
            fingerprint = _next_fingerprint(session, session.scalars(select(StateRow)).one())
            if fingerprint is None:
                return False
            return session.scalars(_unfinished(fingerprint, waiting=waiting).limit(1)).first() is not None

    def left_behind(self, fingerprint: str) -> bool:
        """Tell whether these are parameters of earlier descriptions: known here, not active, not the next."""
        ours = VocabularyRow.fingerprint == fingerprint
        used = VocabularyRow.id.in_((StateRow.vocabulary_id, StateRow.next_vocabulary_id))
        with reading(self._engine) as session:
            known = session.scalars(select(VocabularyRow.id).where(ours).limit(1)).first()
            now_used = session.scalars(select(VocabularyRow.id).join(StateRow, used).where(ours).limit(1))
            active = session.scalars(select(StateRow.vocabulary_id)).one()  # None while the first is added
            return known is not None and active is not None and now_used.first() is None


def _next_fingerprint(session: Session, state: StateRow) -> str | None:
    if state.next_vocabulary_id is None:
        return None
    return known_vocabulary(session, state.next_vocabulary_id).fingerprint


def _unfinished(fingerprint: str, *, waiting: bool = True) -> Select[str]:
    """Ready shapes without an outcome; one that came meanwhile may have been described by these already."""
    outcome = exists().where(RenewalRow.shape_id == ShapeRow.id, RenewalRow.fingerprint == fingerprint)
    query = select(ShapeRow.id).where(_ready, ShapeRow.fingerprint != fingerprint, ~outcome)
    return query if waiting else query.where(~exists().where(JobRow.shape_id == ShapeRow.id))


def _renewing(session: Session, job: Job, outcome: str = Status.READY) -> ShapeRow:
    """End a job; return the row of its shape, which is there and ready as long as the job is."""
    end_job(session, job, outcome)
    if job.fingerprint is None:
        raise LeaseLost(f"job {job.id} is about an upload")
    return shape_row(session, job.shape_id)


def _take_over(session: Session, fingerprint: str) -> None:
    ours = RenewalRow.shape_id == ShapeRow.id, RenewalRow.fingerprint == fingerprint
    facts = select(RenewalRow.facts).where(*ours).scalar_subquery()
    session.execute(
        update(ShapeRow)
        .where(_ready, exists().where(*ours, RenewalRow.error_code.is_(None)))
        .values(fingerprint=fingerprint, made_in=fingerprint, facts=facts)
        .execution_options(synchronize_session=False)
    )


def _fail(session: Session, fingerprint: str, revision: int) -> None:
    ours = RenewalRow.shape_id == ShapeRow.id, RenewalRow.fingerprint == fingerprint
    reasons = {
        name: select(getattr(RenewalRow, name)).where(*ours).scalar_subquery()
        for name in ("error_code", "error_detail")
    }
    session.execute(
        update(ShapeRow)
        .where(_ready, exists().where(*ours, RenewalRow.error_code.is_not(None)))
        .values(status=Status.FAILED, revision=revision, updated_at=now(), **reasons)
        .execution_options(synchronize_session=False)
    )


def _outdated_rows(upcoming: str | None) -> ColumnElement[bool]:
    return RenewalRow.fingerprint.is_not(None) if upcoming is None else RenewalRow.fingerprint != upcoming


def _outdated(upcoming: str | None, limit: int) -> Select[str]:
    return select(RenewalRow.shape_id).where(_outdated_rows(upcoming)).limit(limit)


def _count(session: Session, query: Select[str]) -> int:
    return session.scalars(select(func.count()).select_from(query.subquery())).one()
