"""Held: what a table of vectors shows, kept beside it and read in the same moment."""

from dataclasses import dataclass

from psycopg import sql

from index.pgvector.cursors import Cursor
from index.pgvector.names import SCHEMA
from index.shapes import CatalogueState

_NAMES = ("library", "epoch", "vocabulary_id", "revision", "form", "lengths", "errors", "number", "has_graph")
_FIELDS = sql.SQL(", ").join(map(sql.Identifier, _NAMES))
_PLACES = sql.SQL("%s, %s, %s, %s, %s, %s, %s::integer[], %s::double precision[], %s, %s")
_TABLE = sql.Identifier(SCHEMA, "held")
_READ = sql.SQL("SELECT {} FROM {} WHERE method = %s").format(_FIELDS, _TABLE)
_FORGET = sql.SQL("DELETE FROM {} WHERE method = %s").format(_TABLE)
_WRITE = sql.SQL("INSERT INTO {} (method, {}) VALUES ({})").format(_TABLE, _FIELDS, _PLACES)


@dataclass(frozen=True, kw_only=True)
class Held:
    """The state of one method's table."""

    state: CatalogueState  # what it shows at least
    form: str  # see `Form.name`; empty while no shape has all the blocks, and there is no table
    lengths: tuple[int, ...]  # numbers in each of the method's blocks
    errors: tuple[float, ...]  # the largest of `Form.errors`, by block
    number: int  # of the table; see `names.table_of`
    has_graph: bool  # whether the table has an HNSW index

    @property
    def empty(self) -> bool:
        """Whether no shape has all the blocks."""
        return not self.form

    def follows(self, state: CatalogueState) -> bool:
        """Whether it shows an earlier moment of the catalogue, of which nothing was replaced since.

        A later moment than the catalogue's own was before that was restored from a copy.
        """
        same = (self.state.library, self.state.epoch) == (state.library, state.epoch)
        return same and self.state.revision <= state.revision


def read_held(cursor: Cursor, method_name: str) -> Held | None:
    """Return what a method's table shows; None where there is none yet."""
    cursor.execute(_READ, [method_name])
    row = cursor.fetchone()
    if row is None:
        return None
    library, epoch, vocabulary_id, revision, form, lengths, errors, number, has_graph = row
    return Held(
        state=CatalogueState(library=library, epoch=epoch, vocabulary_id=vocabulary_id, revision=revision),
        form=form,
        lengths=tuple(lengths),
        errors=tuple(errors),
        number=number,
        has_graph=has_graph,
    )


def write_held(cursor: Cursor, method_name: str, held: Held) -> None:
    """Put down what a method's table shows when this transaction ends."""
    state = held.state
    values = [
        method_name, state.library, state.epoch, state.vocabulary_id, state.revision, held.form,
        list(held.lengths), list(held.errors), held.number, held.has_graph,
    ]  # fmt: skip
    cursor.execute(_FORGET, [method_name])
    cursor.execute(_WRITE, values)
