"""Table: the vectors of one method in PostgreSQL, with the exact rows beside them.

The exact rows lie apart from the vectors wherever both do not fit in a quarter of a page, so that a scan of
all vectors reads little else, and the few rows that are compared exactly cost one look each.
"""

from collections.abc import Collection, Sequence

from psycopg import sql

from index.arrays import RowArray
from index.pgvector.copying import copied
from index.pgvector.cursors import Cursor
from index.pgvector.form import Form
from index.pgvector.names import SCHEMA, table_of

_CREATE = "CREATE TABLE {} (id text NOT NULL, vector {} NOT NULL, exact bytea NOT NULL)"
_STORAGE = "ALTER TABLE {} ALTER vector SET STORAGE {}, ALTER exact SET STORAGE EXTERNAL"


class Table:
    """One table of vectors.

    Parameters
    ----------
    cursor : Cursor
        Of a transaction that writes.
    form : Form
        Of every row.
    number : int
        See `names.table_of`.
    """

    def __init__(self, cursor: Cursor, form: Form, number: int) -> None:
        self._cursor = cursor
        self.form = form
        self._name = table_of(form.layout.method.name, number)
        self.errors = (0.0,) * len(form.layout.lengths)  # the largest of what was put, by block

    def create(self) -> None:
        """Make the table, empty."""
        self._run(sql.SQL(_CREATE).format(self._name, sql.SQL(self.form.column)))
        storage = sql.SQL("PLAIN" if self.form.in_page else "EXTERNAL")
        self._run(sql.SQL(_STORAGE).format(self._name, storage))

    def append(self, ids: Sequence[str], rows: RowArray) -> None:
        """Add rows (m, width) under ids that are new."""
        kept = self.form.kept(rows)
        worst = self.form.errors(rows, kept).max(axis=0).tolist()
        self.errors = tuple(map(max, self.errors, worst))
        into = sql.SQL("COPY {} (id, vector, exact) FROM STDIN WITH (FORMAT BINARY)").format(self._name)
        with self._cursor.copy(into) as copy:
            for piece in copied(ids, kept, rows):
                copy.write(piece)

    def put(self, ids: Sequence[str], rows: RowArray) -> None:
        """Add rows (m, width) under distinct ids; what was known under them is removed."""
        self.remove(ids)
        self.append(ids, rows)

    def remove(self, ids: Collection[str]) -> None:
        """Forget rows; unknown ids are fine."""
        if ids:
            delete = sql.SQL("DELETE FROM {} WHERE id = ANY(%s)").format(self._name)
            self._cursor.execute(delete, [list(ids)])

    def add_key(self) -> None:
        """Let rows be found by their ids; quickest when all are there."""
        self._run(sql.SQL("ALTER TABLE {} ADD PRIMARY KEY (id)").format(self._name))

    def add_graph(self) -> None:
        """Make an HNSW index: for each row a few near ones, by which a search goes from row to row."""
        kind = sql.SQL(f"{'halfvec' if self.form.halves else 'vector'}_l1_ops")
        self._run(sql.SQL("CREATE INDEX ON {} USING hnsw (vector {})").format(self._name, kind))

    def measure(self) -> None:
        """Let PostgreSQL know how many rows there are; it plans by that."""
        self._run(sql.SQL("ANALYZE {}").format(self._name))

    def drop(self) -> None:
        """Remove the table; searches that read it come to their end before."""
        self._run(sql.SQL("DROP TABLE IF EXISTS {}").format(self._name))

    def _run(self, statement: sql.Composed) -> None:
        self._cursor.execute(statement)


def drop_others(cursor: Cursor, method_name: str, number: int) -> None:
    """Drop a method's tables but the one of this number."""
    mine = "SELECT tablename FROM pg_tables WHERE schemaname = %s AND tablename ~ %s AND tablename <> %s"
    cursor.execute(mine, [SCHEMA, f"^{method_name}-[0-9]+$", f"{method_name}-{number}"])
    for (name,) in cursor.fetchall():
        cursor.execute(sql.SQL("DROP TABLE {}").format(sql.Identifier(SCHEMA, name)))
