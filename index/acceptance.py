"""Acceptance: an upload becomes a shape and a job, together or not at all, and only once."""

from collections.abc import Mapping, Sequence
from typing import Any

from sqlalchemy import Engine, delete, select
from sqlalchemy.orm import Session

from index.database import reading, writing
from index.errors import NotFailed
from index.jobs import enqueue
from index.revisions import lock_state, now, touch
from index.rows import describe_for_search, file_rows, shape_of, shape_row
from index.shapes import Shape, Status, StoredFile
from index.tables import ShapeRow, TombstoneRow
from index.tags import write_tags


class Acceptance:
    """How shapes come in."""

    _engine: Engine

    def accept(
        self,
        *,
        id: str,  # noqa: A002 - the column's name
        name: str,
        metadata: Mapping[str, Any],
        sha256: str,
        files: Sequence[StoredFile],
        allow_untextured: bool = False,
    ) -> tuple[Shape, bool]:
        """Keep a new shape and its job in one commit.

        Returns
        -------
        (Shape, bool)
            The new shape and True. Where the same content is known: that shape and False, nothing
            changed; but if it had failed, it is queued again under its own id with what came now, and True.
        """
        with writing(self._engine) as session:
            lock_state(session)
            row = session.execute(select(ShapeRow).where(ShapeRow.sha256 == sha256)).scalar_one_or_none()
            if row is not None and row.status != Status.FAILED:
                return shape_of(row), False
            if row is None:
                row = _new_row(session, id, sha256)
            row.name, row.user_metadata, row.allow_untextured = name, dict(metadata), allow_untextured
            row.files.clear()
            session.flush()  # the old files' rows go before the new ones take their places
            row.files.extend(file_rows(files))
            describe_for_search(row)
            write_tags(session, row)
            _queue(session, row)
            return shape_of(row), True

    def find_content(self, sha256: str) -> Shape | None:
        """Return the shape with this content, if there is one."""
        with reading(self._engine) as session:
            row = session.execute(select(ShapeRow).where(ShapeRow.sha256 == sha256)).scalar_one_or_none()
            return None if row is None else shape_of(row)

    def retry(self, shape_id: str) -> Shape:
        """Queue a shape that failed again; NotFailed for any other."""
        with writing(self._engine) as session:
            lock_state(session)
            row = shape_row(session, shape_id)
            if row.status != Status.FAILED:
                raise NotFailed(f"only a failed shape can be tried again; this one is {row.status}")
            _queue(session, row)
            return shape_of(row)


def _new_row(session: Session, shape_id: str, sha256: str) -> ShapeRow:
    session.execute(delete(TombstoneRow).where(TombstoneRow.shape_id == shape_id))  # it lives again
    moment = now()
    row = ShapeRow(
        id=shape_id,
        name="",
        user_metadata={},
        searchable="",
        allow_untextured=False,
        status=Status.QUEUED,
        created_at=moment,
        updated_at=moment,
        sha256=sha256,
        revision=0,
    )
    touch(session, row)
    row.sequence = row.revision
    session.add(row)
    return row


def _queue(session: Session, row: ShapeRow) -> None:
    row.status, row.error_code, row.error_detail = Status.QUEUED, None, None
    touch(session, row)
    enqueue(session, row.id)
