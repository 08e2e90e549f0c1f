"""Fill the tables of docs/scaling.md: `python -m benchmarks.scaling postgresql://…`, an empty database.

The server should have fsync on, as usual, and room for the tables in its shared buffers.
"""

import argparse
import time
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from sqlalchemy import Engine
from threadpoolctl import threadpool_limits

from benchmarks.made_rows import Blocks, described_blocks, make_rows
from benchmarks.pages import fill_page, table_of
from benchmarks.scaling_arithmetic import arithmetic
from benchmarks.spent import Spending
from benchmarks.vector_tables import Row, build, search_rows, size_row, wrong_answers
from index.database import make_engine
from index.methods import METHODS
from index.pgvector.extension import prepare

PAGE = Path(__file__).parents[1] / "docs" / "scaling.md"
DESCRIBED = 24  # shapes of which rows are made
QUERIES = 40
COMPARED = 20_000  # rows of each method whose answers are compared with those in memory
TIMED = ("fused", "chks")
OWN = 3.5  # weight of a method's first block


def main() -> None:
    """Fill tables, ask, fill in."""
    options = _options()
    start = time.perf_counter()
    tables = {"arithmetic": table_of(list(arithmetic()))}
    if options.database is not None:
        tables |= measured(options.database, options.rows, options.graph_rows)
    fill_page(options.page, tables)
    print(f"{options.page.name}: {', '.join(tables)}; {time.perf_counter() - start:.0f} s")


def measured(database: str, sizes: Sequence[int], graph_rows: int) -> Mapping[str, str]:
    """Return the tables that are measured; graphs are made up to a number of rows."""
    engine = make_engine(database)
    prepare(engine)
    with threadpool_limits(1):
        described, spending = described_blocks(DESCRIBED), Spending(engine)
        searched = list(by_size(engine, spending, described, sizes, graph_rows))
        same = list(equality(engine, spending, described))
    engine.dispose()
    queries = [row for rows, _ in searched for row in rows]
    return {
        "queries": table_of(queries),
        "room": table_of([room for _, room in searched]),
        "same": table_of(same),
    }


def by_size(
    engine: Engine, spending: Spending, described: Sequence[Blocks], sizes: Sequence[int], graph_rows: int
) -> Iterator[tuple[list[Row], Row]]:
    """Yield what queries cost and what tables take, for each size and method."""
    for size in sizes:
        for name in TIMED:
            made = make_rows(described, METHODS[name], size, QUERIES)
            built = build(engine, spending, made, graph=size <= graph_rows)
            yield list(search_rows(engine, spending, built)), size_row(engine, spending, built)


def equality(engine: Engine, spending: Spending, described: Sequence[Blocks]) -> Iterator[Row]:
    """Compare answers of every method with those in memory, with its own weights and with others."""
    for name, method in METHODS.items():
        made = make_rows(described, method, COMPARED, QUERIES)
        made.rows[1::4] = made.rows[::4]  # ties
        built = build(engine, spending, made, graph=False)
        count, wrong, looks = wrong_answers(engine, built, {method.blocks[0].name: OWN})
        yield {
            "method": f"`{name}`",
            "rows": f"{COMPARED:,}",
            "queries": str(count),
            "other answers than in memory": str(wrong),
            "second looks": str(looks),
        }


def _options() -> argparse.Namespace:
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument(
        "database", nargs="?", help="an empty one in PostgreSQL; without: arithmetic alone"
    )
    arguments.add_argument("--rows", type=int, nargs="*", default=[20_000, 200_000])
    arguments.add_argument("--graph-rows", type=int, default=20_000, help="rows up to which graphs are made")
    arguments.add_argument("--page", type=Path, default=PAGE, help="whose tables are filled")
    return arguments.parse_args()


if __name__ == "__main__":
    main()
