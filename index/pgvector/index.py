"""PgvectorIndex: the vectors of one method in a table that all processes share.

Whoever searches first after a change brings the table up to date, in one transaction and one process at a
time; the others wait for it, and then see what it committed. Writing the vectors with the description would
make each of them wait for the tables of all methods, and could neither follow another vocabulary nor begin
with a library that is there already. As it is, one way serves all cases, the same as in memory.
"""

from collections.abc import Collection, Mapping
from threading import Lock

import numpy.typing as npt
from psycopg.errors import UndefinedTable
from sqlalchemy import Engine

from index.catalogue import Catalogue
from index.errors import CatalogueBusy, VocabularyChanged
from index.layout import Layout
from index.methods import Method
from index.pgvector.cursors import Cursor, reading_cursor
from index.pgvector.following import Following
from index.pgvector.form import Form
from index.pgvector.held import Held, read_held
from index.pgvector.ranking import FROM_GRAPH, MORE, TIMES, Found, Ranking
from index.ranking import Ranked
from index.watch import tell_compared

ATTEMPTS = 5  # at a table that is replaced in the moment in which it is read


class PgvectorIndex:
    """A view of the catalogue that ranks by one method, for any number of processes.

    Parameters
    ----------
    method : Method
        From the table, with its own weights.
    catalogue : Catalogue
        The truth.
    engine : Engine
        Of the catalogue's database, which `index.pgvector.extension.prepare` has seen.
    graph : bool
        Whether candidates come from an HNSW index: quick in any number of rows, and unproven.
    """

    def __init__(self, method: Method, catalogue: Catalogue, engine: Engine, *, graph: bool = False) -> None:
        self.escalations = 0  # queries whose first candidates proved nothing, since the start of this process
        self._method = method
        self._engine = engine
        self._catalogue = catalogue
        self._graph = graph
        self._following = Following(method, catalogue, engine, graph=graph)
        self._counting = Lock()
        self._updating = Lock()  # one thread waits for other processes, the others for it

    @property
    def revision(self) -> int | None:
        """Return the catalogue's revision that the table shows; None where there is none yet."""
        with reading_cursor(self._engine) as cursor:
            held = read_held(cursor, self._method.name)
        return None if held is None else held.state.revision

    def catch_up(self) -> None:
        """Bring the table to what the catalogue is now; two cheap SELECTs where nothing is new."""
        if self._following.shows():
            return
        wanted = self._catalogue.revision()
        with self._updating:
            while not self._following.shows(wanted):
                self._following.follow()

    def proves(self, method: Method, limit: int) -> bool:
        """Whether answers to such a question are sure to be proven complete."""
        own = method.blocks == self._method.blocks  # a graph knows no others
        return not (self._graph and own and TIMES * limit + MORE <= FROM_GRAPH)

    def rank(
        self,
        method: Method,
        blocks: Mapping[str, npt.ArrayLike],
        limit: int,
        exclude: Collection[str],
        vocabulary_id: str | None,
    ) -> Ranked:
        """Return the nearest shapes; see `index.searcher.Searcher.search`."""
        for _ in range(ATTEMPTS):
            try:
                with reading_cursor(self._engine) as cursor:
                    held = read_held(cursor, self._method.name)
                    found = self._ranked(cursor, held, method, blocks, limit, exclude, vocabulary_id)
            except UndefinedTable:  # it was built anew meanwhile
                continue
            with self._counting:
                self.escalations += found.escalated
            tell_compared(self._method.name, found.compared, 0, found.escalated)
            return found.ranked
        raise CatalogueBusy("the index kept being built anew during the query; try again")

    def save(self) -> None:
        """Do nothing: what is in PostgreSQL is kept."""

    def _ranked(
        self,
        cursor: Cursor,
        held: Held | None,
        method: Method,
        blocks: Mapping[str, npt.ArrayLike],
        limit: int,
        exclude: Collection[str],
        vocabulary_id: str | None,
    ) -> Found:
        active = held.state.vocabulary_id if held else None
        if vocabulary_id not in (None, active):
            raise VocabularyChanged(f"the active vocabulary is {active}, not {vocabulary_id}")
        if held is None or held.empty or limit <= 0:
            return Found(ranked=[])
        layout = Layout(method=self._method, lengths=held.lengths)
        ranking = Ranking(cursor, Form(layout), held, layout.join(blocks), exclude, method)
        if self.proves(method, limit) or not held.has_graph:
            return ranking.proven(limit)
        return ranking.from_graph(limit)
