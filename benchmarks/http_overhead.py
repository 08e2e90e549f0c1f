"""What a question over HTTP costs beyond the index's own time and registration, by one client and by 50."""

import multiprocessing
import os
import statistics
import tempfile
from collections.abc import Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from benchmarks.asking import Asked, ask_all
from benchmarks.made_library import make_library
from benchmarks.timed_server import TimedServer

SHAPES, QUERIES = 2_000, 100  # queries are the first shapes
CLIENTS = (1, 50)
METHODS = ("fused", "chks")
REQUESTS = 600  # of each row, after as many to warm up as there are clients
COLUMNS = (
    "method",
    "clients",
    "median ms",
    "95 % ms",
    "index CPU ms",
    "registration CPU ms",
    "overhead CPU ms",
    "requests a second",
    "failures",
)

Row = Mapping[str, str]  # column → cell


def rows(n_shapes: int = SHAPES, n_requests: int = REQUESTS) -> list[Row]:
    """Measure; the library is made in a folder that is gone afterwards.

    Returns
    -------
    list of mapping
        Of COLUMNS. Latency is the client's, processor time the server's for a request. What is neither the
        index's nor registration's is the overhead: HTTP, JSON and the catalogue.
    """
    context = multiprocessing.get_context("spawn")
    with tempfile.TemporaryDirectory() as folder, ProcessPoolExecutor(1, context) as client:
        ids = make_library(Path(folder), n_shapes)[:QUERIES]
        with TimedServer(Path(folder), context) as server:
            return [
                _row(server, client, ids, method, clients, n_requests)
                for method in METHODS
                for clients in CLIENTS
            ]


def table_of(measured: Sequence[Row]) -> str:
    """Return rows as a table in Markdown."""
    lines = [
        COLUMNS,
        ["---", *["--:"] * (len(COLUMNS) - 1)],
        *([row[column] for column in COLUMNS] for row in measured),
    ]
    return "".join(f"| {' | '.join(cells)} |\n" for cells in lines)


def _row(
    server: TimedServer,
    client: ProcessPoolExecutor,
    ids: Sequence[str],
    method: str,
    clients: int,
    n_requests: int,
) -> Row:
    paths = [f"/v1/shapes/{shape_id}/similar?method={method}" for shape_id in ids]

    def ask(n: int) -> Asked:
        return client.submit(ask_all, server.port, paths, clients, n).result()

    ask(max(clients, 20))
    before = server.times()
    asked = ask(n_requests)
    spent = {part: 1000.0 * (after - before[part]) / n_requests for part, after in server.times().items()}
    others = spent["all"] - spent["index"] - spent["registration"]
    latencies = statistics.quantiles(asked.milliseconds, n=100)
    return dict(
        zip(
            COLUMNS,
            (
                method,
                str(clients),
                f"{latencies[49]:.1f}",
                f"{latencies[94]:.1f}",
                f"{spent['index']:.2f}",
                f"{spent['registration']:.2f}",
                f"{others:.2f}",
                f"{n_requests / asked.seconds:.0f}",
                str(asked.failures),
            ),
            strict=True,
        )
    )


def main() -> None:
    """Print the table."""
    os.environ["OMP_NUM_THREADS"] = "1"  # for the processes that are started
    print(table_of(rows()))


if __name__ == "__main__":
    main()
