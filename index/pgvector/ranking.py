"""Ranking: PostgreSQL gives candidates, exact distances order them, and the scan proves that none is missing.

1. The scan's numbers (see `index.pgvector.scans`) give a few more rows than are wanted. The k-th least of
   their exact distances is a limit: what is farther is not among the k nearest.
2. All other rows have the last one's number, or a larger one. Where that puts them beyond the limit, the
   answer is proven.
3. Where it does not, all rows are taken whose number does not rule them out. That is proven in any case.

Candidates from a graph (HNSW) prove nothing, since rows may be missing: whoever asks for them knows.
"""

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np
from psycopg import sql

from index.arrays import DoubleArray, RowArray
from index.distances import distances
from index.methods import Method
from index.pgvector.cursors import Cursor
from index.pgvector.form import Form
from index.pgvector.held import Held
from index.pgvector.names import table_of
from index.pgvector.scans import Scan, scan_for, vector_literal
from index.ranking import Ranked

TIMES, MORE = 2, 16  # candidates: so many times as many rows as are wanted, and so many more
FROM_GRAPH = 400  # candidates at most that a graph is asked for: beyond it a scan is not much slower
WIDTH = 4  # rows that a graph keeps in sight for each candidate: the more, the fewer it misses
_WIDEST, _NARROWEST = 1000, 40  # that pgvector takes, and its own

Row = tuple[str, bytes, float]  # id, exact row, number of the scan


@dataclass(frozen=True, kw_only=True)
class Found:
    """A ranked answer, and how it came about."""

    ranked: Ranked
    exact: bool = True  # whether no row can be missing
    escalated: bool = False  # whether the first candidates did not prove it
    compared: int = 0  # rows, exactly


class Ranking:
    """One query to one table.

    Parameters
    ----------
    cursor : Cursor
        Of a transaction that sees one moment.
    form : Form
        Of the table.
    held : Held
        What the table shows.
    query : (width,) array
        As the layout keeps it.
    exclude : collection of str
        Ids that are not wanted.
    method : Method
        The table's, perhaps with other weights.
    """

    def __init__(
        self,
        cursor: Cursor,
        form: Form,
        held: Held,
        query: RowArray,
        exclude: Collection[str],
        method: Method,
    ) -> None:
        self._cursor = cursor
        self._form = form
        self._query = query
        self._method = method
        self._scan = scan_for(form, method, query, np.array(held.errors))
        self._table = table_of(form.layout.method.name, held.number)
        self._hidden = list(exclude)

    def proven(self, limit: int) -> Found:
        """Return the nearest rows; none is missing."""
        candidates = self._first(self._scan, TIMES * limit + MORE)
        ids, found = self._compared(candidates)
        if len(candidates) < TIMES * limit + MORE:  # that was all
            return Found(ranked=_nearest(ids, found, limit), compared=len(ids))
        worst = float(np.partition(found, limit - 1)[limit - 1])
        if self._scan.least(candidates[-1][2]) > worst:
            return Found(ranked=_nearest(ids, found, limit), compared=len(ids))
        ids, found = self._compared(self._within(worst))
        compared = len(candidates) + len(ids)
        return Found(ranked=_nearest(ids, found, limit), escalated=True, compared=compared)

    def from_graph(self, limit: int) -> Found:
        """Return near rows, by an index that may miss some."""
        n_candidates = TIMES * limit + MORE
        width = min(max(WIDTH * n_candidates, _NARROWEST), _WIDEST)
        self._cursor.execute(f"SET LOCAL hnsw.ef_search = {width:d}")
        self._cursor.execute("SET LOCAL hnsw.iterative_scan = 'strict_order'")  # until there are enough
        self._cursor.execute("SET LOCAL enable_seqscan = off")  # a plan by estimates might read all rows
        ids, found = self._compared(self._first(self._along_graph(), n_candidates))
        return Found(ranked=_nearest(ids, found, limit), exact=False, compared=len(ids))

    def _along_graph(self) -> Scan:
        number = sql.SQL("vector <+> %(whole)s::{}").format(sql.SQL(self._form.column))
        whole = vector_literal(self._form, self._query)
        return Scan(number=number, values={"whole": whole}, slack=0.0, rate=1.0)

    def _first(self, scan: Scan, count: int) -> list[Row]:
        """Return so many rows with the least numbers, ascending."""
        end = sql.SQL("ORDER BY {} LIMIT {}").format(scan.number, sql.Literal(count))
        return self._rows(scan, sql.SQL("TRUE"), end)

    def _within(self, distance: float) -> list[Row]:
        """Return all rows that may be within a distance."""
        reach = sql.Literal(self._scan.reach(distance))
        condition = sql.SQL("{} <= {}::float8").format(self._scan.number, reach)
        return self._rows(self._scan, condition, sql.SQL(""))

    def _rows(self, scan: Scan, condition: sql.Composable, end: sql.Composable) -> list[Row]:
        statement = sql.SQL(
            "SELECT id, exact, {} FROM {} WHERE id <> ALL(%(hidden)s::text[]) AND {} {}"
        ).format(scan.number, self._table, condition, end)
        # planned with its values: a vector is read from its text once, not for every row
        self._cursor.execute(statement, {**scan.values, "hidden": self._hidden}, prepare=False)
        return self._cursor.fetchall()

    def _compared(self, candidates: Sequence[Row]) -> tuple[list[str], DoubleArray]:
        """Return the ids and exact distances of candidates."""
        layout = self._form.layout
        joined = b"".join(exact for _, exact, _ in candidates)
        rows = np.frombuffer(joined, layout.dtype).reshape(len(candidates), layout.width)
        found = distances(rows, np.arange(len(rows)), self._query, layout, self._method)
        return [shape_id for shape_id, _, _ in candidates], found


def _nearest(ids: Sequence[str], found: DoubleArray, limit: int) -> Ranked:
    """Order by distance, equal distances by id."""
    ranked = sorted(zip(found.tolist(), ids, strict=True))
    return [(shape_id, distance) for distance, shape_id in ranked[:limit]]
