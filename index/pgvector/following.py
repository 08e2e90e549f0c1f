"""Following: a table of vectors is brought to what the catalogue is now, in one transaction."""

import logging
from collections.abc import Iterable
from dataclasses import replace

from sqlalchemy import Engine

from index.catalogue import Catalogue
from index.errors import CatalogueBusy
from index.gathering import Gathered, gather
from index.layout import Layout
from index.methods import Method
from index.pgvector.cursors import Cursor, reading_cursor, wait_for_turn, writing_cursor
from index.pgvector.form import Form
from index.pgvector.held import Held, read_held, write_held
from index.pgvector.names import lock_number
from index.pgvector.table import Table, drop_others
from index.shapes import CatalogueState

_log = logging.getLogger(__name__)


class _Overtaken(Exception):
    """Another vocabulary became active while the rows were read."""


class Following:
    """Brings one method's table up to date.

    Parameters
    ----------
    method : Method
        From the table of methods, with its own weights.
    catalogue : Catalogue
        The truth.
    engine : Engine
        Of its database.
    graph : bool
        Whether the table needs an HNSW index.
    """

    def __init__(self, method: Method, catalogue: Catalogue, engine: Engine, *, graph: bool) -> None:
        self._method = method
        self._names = [block.name for block in method.blocks]
        self._catalogue = catalogue
        self._engine = engine
        self._graph = graph

    def shows(self, revision: int | None = None) -> bool:
        """Tell whether the table shows the catalogue, at least at a revision: the last one unless told."""
        with reading_cursor(self._engine) as cursor:
            held = read_held(cursor, self._method.name)
        state = self._catalogue.state()  # read after the table's, which cannot be later then
        return self._is_current(held, state, state.revision if revision is None else revision)

    def follow(self) -> None:
        """Bring the table up to date, unless another process just did or another vocabulary came."""
        try:
            with writing_cursor(self._engine) as cursor:
                before, after = self._follow(cursor)
        except _Overtaken as overtaken:
            _log.info("the index of %s is brought up to date once more: %s", self._method.name, overtaken)
            return
        if before is not None and before.number != after.number:
            self._sweep()

    def _follow(self, cursor: Cursor) -> tuple[Held | None, Held]:
        """Return what the table showed, and what it shows when the transaction ends."""
        wait_for_turn(cursor, lock_number(self._method.name))
        held, state = read_held(cursor, self._method.name), self._catalogue.state()
        if held is not None and self._is_current(held, state, state.revision):
            return held, held
        followed = self._followed(cursor, held, state)
        write_held(cursor, self._method.name, followed)
        self._require(state)
        return held, followed

    def _is_current(self, held: Held | None, state: CatalogueState, revision: int) -> bool:
        if held is None or not held.follows(state) or held.state.revision < revision:
            return False
        return held.empty or (self._fits(held) and held.has_graph >= self._wants_graph(self._form(held)))

    def _fits(self, held: Held) -> bool:
        """Whether this version keeps rows as the table does."""
        return self._form(held).name == held.form

    def _wants_graph(self, form: Form) -> bool:
        return self._graph and form.in_page  # no graph takes wider vectors

    def _form(self, held: Held) -> Form:
        return Form(Layout(method=self._method, lengths=held.lengths))

    def _followed(self, cursor: Cursor, held: Held | None, state: CatalogueState) -> Held:
        if held is None or held.empty or not held.follows(state) or not self._fits(held):
            return self._built(cursor, held, state)
        followed = self._changed(cursor, held, state)
        if self._wants_graph(self._form(held)) and not held.has_graph:
            self._table(cursor, held).add_graph()
            followed = replace(followed, has_graph=True)
        return followed

    def _changed(self, cursor: Cursor, held: Held, state: CatalogueState) -> Held:
        """Put what is new, and remove what is gone."""
        table = self._table(cursor, held)
        since = held.state.revision
        changes = self._catalogue.changes_since(since)
        gone = {*changes.changed, *changes.removed}
        for _, ids, rows in self._gather(state, since):
            table.put(ids, rows)
            gone.difference_update(ids)
        table.remove(gone)
        errors = tuple(map(max, held.errors, table.errors))
        return replace(held, state=state, errors=errors)

    def _built(self, cursor: Cursor, held: Held | None, state: CatalogueState) -> Held:
        """Make a new table beside the one that is searched."""
        number = held.number + 1 if held else 1
        table = self._filled(cursor, number, self._gather(state))
        if table is None:
            return Held(state=state, form="", lengths=(), errors=(), number=number, has_graph=False)
        form = table.form
        return Held(
            state=state,
            form=form.name,
            lengths=form.layout.lengths,
            errors=table.errors,
            number=number,
            has_graph=self._wants_graph(form),
        )

    def _filled(self, cursor: Cursor, number: int, pieces: Iterable[Gathered]) -> Table | None:
        table: Table | None = None
        for layout, ids, rows in pieces:
            if table is None:
                table = Table(cursor, Form(layout), number)
                table.drop()  # what another library left under this name
                table.create()
            table.append(ids, rows)
        if table is not None:
            table.add_key()
            table.measure()
            if self._wants_graph(table.form):
                table.add_graph()
        return table

    def _sweep(self) -> None:
        """Drop tables that were replaced; one that is still read goes another time."""
        try:
            with writing_cursor(self._engine) as cursor:
                wait_for_turn(cursor, lock_number(self._method.name))
                held = read_held(cursor, self._method.name)
                drop_others(cursor, self._method.name, held.number if held else 0)
        except CatalogueBusy:
            _log.info("a table of %s that was replaced is still read", self._method.name)

    def _table(self, cursor: Cursor, held: Held) -> Table:
        return Table(cursor, self._form(held), held.number)

    def _gather(self, state: CatalogueState, after_revision: int = 0) -> Iterable[Gathered]:
        return gather(
            self._catalogue.block_rows(state.vocabulary_id, after_revision, self._names), self._method
        )

    def _require(self, state: CatalogueState) -> None:
        # With another vocabulary active, the rows that were read may lack the old one's blocks.
        now = self._catalogue.state()
        if (now.library, now.epoch) != (state.library, state.epoch):
            raise _Overtaken("another vocabulary came")
