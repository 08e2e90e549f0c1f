"""Revisions: every change has a number, and whoever watches asks for what is newer."""

from datetime import UTC, datetime
from functools import cached_property

from sqlalchemy import Engine, select
from sqlalchemy.orm import Session

from index.database import looking, reading
from index.prepared import Prepared
from index.shapes import CatalogueState, Changes
from index.tables import ShapeRow, StateRow, TombstoneRow


def lock_state(session: Session) -> StateRow:
    """Return the state, locked until this transaction ends: the first step of every change.

    SQLite has one writer anyway; on other databases this puts the writers in a row, so that
    revisions become visible in their order.
    """
    return session.execute(select(StateRow).with_for_update()).scalar_one()


def next_revision(session: Session) -> int:
    """Raise the catalogue's revision and return it."""
    state = lock_state(session)
    state.revision += 1
    return state.revision


def touch(session: Session, row: ShapeRow) -> None:
    """Mark a shape as changed now."""
    row.revision = next_revision(session)
    row.updated_at = now()


def now() -> datetime:
    """Return this moment, aware."""
    return datetime.now(UTC)


class Revisions:
    """What changed, and when."""

    _engine: Engine

    def state(self) -> CatalogueState:
        """Return what an index must compare; one cheap SELECT."""
        with looking(self._engine) as cursor:
            ((library, revision, epoch, vocabulary_id, next_id),) = self._state.rows(cursor, {})
        return CatalogueState(
            library=library,
            revision=revision,
            epoch=epoch,
            vocabulary_id=vocabulary_id,
            next_vocabulary_id=next_id,
        )

    @cached_property
    def _state(self) -> Prepared:
        row = StateRow.__table__.c
        columns = (row.library, row.revision, row.epoch, row.vocabulary_id, row.next_vocabulary_id)
        return Prepared(select(*columns), self._engine.dialect)

    def revision(self) -> int:
        """Return the number of the last change."""
        return self.state().revision

    def changes_since(self, revision: int) -> Changes:
        """Return which shapes were changed or removed after `revision`.

        A change that happens while this runs may be told now and again next time, never missed.
        """
        with reading(self._engine) as session:
            upto = session.scalars(select(StateRow.revision)).one()
            changed = select(ShapeRow.id).where(ShapeRow.revision > revision).order_by(ShapeRow.revision)
            removed = select(TombstoneRow.shape_id).where(TombstoneRow.revision > revision)
            return Changes(
                revision=upto,
                changed=tuple(session.scalars(changed)),
                removed=tuple(session.scalars(removed.order_by(TombstoneRow.revision))),
            )
