"""What searches cost with vectors in memory, in tables of PostgreSQL, and along a graph in them."""

import statistics
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from typing import TypeVar

from psycopg import sql
from sqlalchemy import Engine

from benchmarks.made_rows import Made
from benchmarks.spent import Spending
from index.arrays import RowArray
from index.methods import Method, with_weights
from index.pgvector.cursors import Cursor, reading_cursor, writing_cursor
from index.pgvector.form import Form
from index.pgvector.held import Held
from index.pgvector.names import table_of
from index.pgvector.ranking import Found, Ranking
from index.pgvector.table import Table
from index.ranking import Ranked, rank
from index.shapes import CatalogueState
from index.vectors import Vectors

LIMIT = 10  # results
PUTS = 20  # of one row
PIECE = 1024  # rows put at once, as `index.gathering` yields them
WORK_MEMORY = "1GB"  # of PostgreSQL, while it makes a graph
STATE = CatalogueState(library="", revision=1, epoch=1, vocabulary_id=None)

Row = Mapping[str, str]  # column → cell
Answer = TypeVar("Answer")


@dataclass(frozen=True, kw_only=True)
class Built:
    """Rows in a table, and what that cost."""

    made: Made
    held: Held
    load_seconds: float  # until all rows are there, with their key
    graph_seconds: float | None  # None without a graph
    table_bytes: int  # vectors, exact rows, key
    graph_bytes: int


def build(engine: Engine, spending: Spending, made: Made, *, graph: bool) -> Built:
    """Put rows into a new table."""
    table, load_seconds = spending.of(partial(_filled, engine, made))
    table_bytes = _bytes(engine, made.layout.method)
    _, graph_seconds = spending.of(partial(_add_graph, engine, made)) if graph else (None, None)
    held = Held(
        state=STATE,
        form=table.form.name,
        lengths=made.layout.lengths,
        errors=table.errors,
        number=1,
        has_graph=graph,
    )
    return Built(
        made=made,
        held=held,
        load_seconds=load_seconds,
        graph_seconds=graph_seconds,
        table_bytes=table_bytes,
        graph_bytes=_bytes(engine, made.layout.method) - table_bytes,
    )


def _filled(engine: Engine, made: Made) -> Table:
    with writing_cursor(engine) as cursor:
        table = Table(cursor, Form(made.layout), 1)
        table.drop()
        table.create()
        for first in range(0, len(made.rows), PIECE):
            some = made.rows[first : first + PIECE]
            table.append([name_of(first + number) for number in range(len(some))], some)
        table.add_key()
        table.measure()
    return table


def name_of(number: int) -> str:
    """Return an id as long as real ones."""
    return f"{number:032x}"


def in_memory(made: Made) -> Vectors:
    """Return the same rows in memory, in order."""
    vectors = Vectors(made.layout)
    vectors.put([name_of(number) for number in range(len(made.rows))], made.rows)
    vectors.settle()
    return vectors


def asked(
    engine: Engine, built: Built, query: RowArray, *, graph: bool = False, own: Method | None = None
) -> Found:
    """Ask a table, perhaps with other weights."""
    method = own or built.made.layout.method
    with reading_cursor(engine) as cursor:
        ranking = Ranking(cursor, Form(built.made.layout), built.held, query, (), method)
        return ranking.from_graph(LIMIT) if graph else ranking.proven(LIMIT)


def search_rows(engine: Engine, spending: Spending, built: Built) -> Iterator[Row]:
    """Yield what queries cost, and what they miss: in memory, proven, along the graph."""
    made, vectors = built.made, in_memory(built.made)
    truth, seconds = _timed(spending, lambda query: rank(vectors, query, LIMIT), made.queries)
    yield _row(made, "memory", seconds, truth, truth)
    found, seconds = _timed(spending, partial(asked, engine, built), made.queries)
    yield _row(made, "pgvector", seconds, [each.ranked for each in found], truth, found)
    if built.held.has_graph:
        found, seconds = _timed(spending, partial(asked, engine, built, graph=True), made.queries)
        yield _row(made, "pgvector-hnsw", seconds, [each.ranked for each in found], truth)


def size_row(engine: Engine, spending: Spending, built: Built) -> Row:
    """Return what a table takes, and how long it takes to fill."""
    n_rows = len(built.made.rows)
    puts = [spending.of(partial(_put_one, engine, built.made, number))[1] for number in range(PUTS)]
    return {
        "method": f"`{built.made.layout.method.name}`",
        "rows": f"{n_rows:,}",
        "in memory, bytes a row": f"{built.made.rows[0].nbytes}",
        "table, bytes a row": f"{built.table_bytes / n_rows:,.0f}",
        "graph, bytes a row": f"{built.graph_bytes / n_rows:,.0f}" if built.graph_bytes else "",
        "load, rows per CPU second": f"{n_rows / built.load_seconds:,.0f}",
        "graph, rows per CPU second": f"{n_rows / built.graph_seconds:,.0f}" if built.graph_seconds else "",
        "one more row, CPU ms": f"{1000 * statistics.median(puts):.1f}",
    }


def wrong_answers(engine: Engine, built: Built, weights: Mapping[str, float]) -> tuple[int, int, int]:
    """Compare a table's answers with those in memory: (queries, wrong ones, second looks)."""
    made, vectors = built.made, in_memory(built.made)
    own = with_weights(made.layout.method, weights)
    wrong = looks = count = 0
    for method in (made.layout.method, own):
        for query in made.queries:
            found = asked(engine, built, query, own=method)
            wrong += found.ranked != rank(vectors, query, LIMIT, (), method)
            looks, count = looks + found.escalated, count + 1
    return count, wrong, looks


def _row(
    made: Made,
    where: str,
    seconds: list[float],
    answers: list[Ranked],
    truth: list[Ranked],
    found: list[Found] | None = None,
) -> Row:
    return {
        "method": f"`{made.layout.method.name}`",
        "rows": f"{len(made.rows):,}",
        "index": f"`{where}`",
        "query, CPU ms": f"{1000 * statistics.median(seconds):.1f}",
        "longest of ten, CPU ms": f"{1000 * sorted(seconds)[int(0.9 * len(seconds))]:.1f}",
        f"recall at {LIMIT}": f"{recall(answers, truth):.3f}",
        "as in memory": f"{sum(map(_same, answers, truth))} of {len(truth)}",
        "second looks": str(sum(each.escalated for each in found)) if found else "",
    }


def recall(answers: list[Ranked], truth: list[Ranked]) -> float:
    """Return the share of true results that were found; one as near as a true one counts."""
    pairs = zip(answers, truth, strict=True)
    found = sum(distance <= true[-1][1] for answer, true in pairs for _, distance in answer)
    return found / sum(map(len, truth))


def _same(answer: Ranked, true: Ranked) -> bool:
    return answer == true


def _timed(
    spending: Spending, ask: Callable[[RowArray], Answer], queries: RowArray
) -> tuple[list[Answer], list[float]]:
    ask(queries[0])  # what is compiled or read for the first time is
    results = [spending.of(partial(ask, query)) for query in queries]
    return [answer for answer, _ in results], [seconds for _, seconds in results]


def _add_graph(engine: Engine, made: Made) -> None:
    with writing_cursor(engine) as cursor:
        cursor.execute(f"SET LOCAL maintenance_work_mem = '{WORK_MEMORY}'")
        Table(cursor, Form(made.layout), 1).add_graph()


def _put_one(engine: Engine, made: Made, number: int) -> None:
    """Put one row in place of another, in a transaction of its own."""
    with writing_cursor(engine) as cursor:
        Table(cursor, Form(made.layout), 1).put([name_of(number)], made.rows[number : number + 1])


def _bytes(engine: Engine, method: Method) -> int:
    with reading_cursor(engine) as cursor:
        name = table_of(method.name, 1).as_string(None)
        return _whole(cursor, sql.SQL("SELECT pg_total_relation_size({})").format(sql.Literal(name)))


def _whole(cursor: Cursor, statement: sql.Composed) -> int:
    cursor.execute(statement)
    (found,) = cursor.fetchone() or (0,)
    return int(found)
