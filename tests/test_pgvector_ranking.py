from collections.abc import Iterator

import numpy as np
import pytest
from psycopg import sql
from sqlalchemy import Engine

from index.database import make_engine
from index.methods import METHODS, with_weights
from index.pgvector.cursors import reading_cursor, writing_cursor
from index.pgvector.extension import prepare
from index.pgvector.names import table_of
from index.pgvector.ranking import Found, Ranking
from index.pgvector.scans import scan_for
from index.pgvector.table import Table
from index.ranking import rank
from tests.databases import DATABASES
from tests.pgvector_rows import Tabled, tabled

ROWS = 2_000


@pytest.fixture(scope="module")
def engine(database_server: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Engine]:
    DATABASES.kind, DATABASES.server = "postgresql", database_server
    try:
        made = make_engine(DATABASES.url(tmp_path_factory.mktemp("ranking")))
    finally:
        DATABASES.kind = "sqlite"
    prepare(made)
    yield made
    made.dispose()


@pytest.fixture(scope="module")
def graphed(engine: Engine) -> Tabled:
    return tabled(engine, "hks", 600, graph=True)


def proven(engine: Engine, rows: Tabled, query: int, limit: int, **more: float) -> Found:
    with reading_cursor(engine) as cursor:
        method = with_weights(rows.form.layout.method, more)
        return Ranking(cursor, rows.form, rows.held, rows.queries[query], (), method).proven(limit)


@pytest.mark.parametrize("name", METHODS)
def test_answers_are_those_of_the_rows_in_memory_bit_for_bit(engine: Engine, name: str) -> None:
    rows = tabled(engine, name, ROWS)
    for number, limit in enumerate((1, 10, 24, ROWS + 1)):
        found = proven(engine, rows, number, limit)
        assert found.ranked == rank(rows.vectors, rows.queries[number], limit)
        assert found.exact
    first, *_ = rows.form.layout.method.blocks
    own = with_weights(rows.form.layout.method, {first.name: 3.5})
    again = proven(engine, rows, 0, 10, **{first.name: 3.5})
    assert again.ranked == rank(rows.vectors, rows.queries[0], 10, (), own)


def test_a_block_of_no_weight_counts_nothing(engine: Engine) -> None:
    rows = tabled(engine, "chks", 200)
    own = with_weights(METHODS["chks"], {"hks-0": 0.0})
    found = proven(engine, rows, 0, 10, **{"hks-0": 0.0})
    assert found.ranked == rank(rows.vectors, rows.queries[0], 10, (), own)


def test_vectors_wider_than_a_page_are_kept_and_compared_too(engine: Engine) -> None:
    rows = tabled(engine, "hks", 40, repeated=60)  # 2 880 numbers of 32 bits
    assert proven(engine, rows, 0, 5).ranked == rank(rows.vectors, rows.queries[0], 5)


def test_many_equal_rows_take_a_second_look_and_come_by_their_ids(engine: Engine) -> None:
    rows = tabled(engine, "hks", 300)
    same = np.repeat(rows.vectors.rows[:1], 300, axis=0)
    with writing_cursor(engine) as cursor:
        table = Table(cursor, rows.form, rows.held.number)
        table.put(list(rows.vectors.ids), same)
    found = proven(engine, rows, 0, 5)
    assert found.escalated
    assert [shape_id for shape_id, _ in found.ranked] == [f"s{number:06}" for number in range(5)]
    assert not proven(engine, rows, 0, 200).escalated  # more candidates than rows: nothing is left to prove


def test_a_graph_gives_true_distances_of_rows_that_are_wanted_and_promises_no_more(
    engine: Engine, graphed: Tabled
) -> None:
    everything = dict(rank(graphed.vectors, graphed.queries[0], 600))
    hidden = list(everything)[:5]
    with reading_cursor(engine) as cursor:
        method = METHODS["hks"]
        ranking = Ranking(cursor, graphed.form, graphed.held, graphed.queries[0], hidden, method)
        found = ranking.from_graph(10)
    assert not found.exact
    assert len(found.ranked) == 10
    assert set(found.ranked) <= set(everything.items())
    assert found.ranked == sorted(found.ranked, key=lambda pair: (pair[1], pair[0]))
    assert not {shape_id for shape_id, _ in found.ranked} & set(hidden)


def test_a_proven_answer_asks_no_graph_even_where_there_is_one(engine: Engine, graphed: Tabled) -> None:
    assert proven(engine, graphed, 0, 10).ranked == rank(graphed.vectors, graphed.queries[0], 10)
    scan = scan_for(graphed.form, METHODS["hks"], graphed.queries[0], np.array(graphed.held.errors))
    along = sql.SQL("vector <+> %(whole)s::vector(48)")
    assert [uses_graph(engine, graphed, number, scan.values) for number in (scan.number, along)] == [
        False,
        True,
    ]


def uses_graph(engine: Engine, rows: Tabled, number: sql.Composable, values: dict[str, str]) -> bool:
    """Tell whether rows in this order would come by an index, were a scan dear."""
    table = table_of("hks", rows.held.number)
    statement = sql.SQL("EXPLAIN SELECT id FROM {} ORDER BY {} LIMIT 10").format(table, number)
    with reading_cursor(engine) as cursor:
        cursor.execute("SET LOCAL enable_seqscan = off")
        cursor.execute(statement, values)
        return any("vector_idx" in line for (line,) in cursor.fetchall())
