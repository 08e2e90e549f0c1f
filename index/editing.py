"""Editing: a shape's name and metadata, and its removal."""

from collections.abc import Mapping
from typing import Any

from sqlalchemy import Engine

from index.database import writing
from index.revisions import lock_state, next_revision, touch
from index.rows import describe_for_search, shape_of, shape_row, stored_files
from index.shapes import Shape, StoredFile
from index.tables import TombstoneRow
from index.tags import write_tags


class Editing:
    """How shapes are changed and removed by their owner."""

    _engine: Engine

    def update(
        self, shape_id: str, *, name: str | None = None, metadata: Mapping[str, Any] | None = None
    ) -> Shape:
        """Replace the name, the metadata or both; None leaves as it is."""
        with writing(self._engine) as session:
            lock_state(session)
            row = shape_row(session, shape_id)
            if name is not None:
                row.name = name
            if metadata is not None:
                row.user_metadata = dict(metadata)
            if name is not None or metadata is not None:
                describe_for_search(row)
                write_tags(session, row)
                touch(session, row)
            return shape_of(row)

    def remove(self, shape_id: str) -> tuple[StoredFile, ...]:
        """Remove a shape with its descriptors and its job; return the files that the caller now deletes."""
        with writing(self._engine) as session:
            lock_state(session)
            row = shape_row(session, shape_id)
            files = stored_files(row)
            session.delete(row)
            session.add(TombstoneRow(shape_id=shape_id, revision=next_revision(session)))
            return files
