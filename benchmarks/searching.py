"""What an exact search costs: against one read of all rows, against faiss, by size, in memory, at the start.

Run by `make bench`, or alone: python -m benchmarks.searching [rows].
"""

import argparse
import statistics
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path

import faiss
import numpy as np
from threadpoolctl import threadpool_limits

from benchmarks.made_rows import Blocks, Made, described_blocks, make_rows
from index.arrays import RowArray, SingleArray
from index.compiled import compiled
from index.distances import distances
from index.index_file import Header, load_index, save_index
from index.local_files import LocalFiles
from index.methods import METHODS
from index.ranking import Ranked, rank
from index.vectors import Vectors

ROWS = 1_000_000
SIZES = (1_000, 10_000, 100_000, 1_000_000)
DESCRIBED = 96  # shapes of which rows are made
QUERIES = 200
BATCH = 64
LIMIT = 20  # results
CHECKED = 20  # queries whose answers are compared with those of brute force
READS = 9
NAMES = ("chks", "fused")

Row = Mapping[str, str]  # column → cell


def main() -> None:
    """Print both tables."""
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("rows", nargs="?", type=int, default=ROWS)
    n_rows = arguments.parse_args().rows
    with threadpool_limits(1):
        described = described_blocks(DESCRIBED)
        for row in (*search_rows(described, n_rows), *size_rows(described)):
            print(row)


def search_rows(described: Sequence[Blocks], n_rows: int = ROWS) -> Iterator[Row]:
    """Yield what searches of a large library cost, one row for each method."""
    faiss.omp_set_num_threads(1)
    for name in NAMES:
        yield search_row(make_rows(described, METHODS[name], n_rows, QUERIES))


def search_row(made: Made) -> Row:
    """Measure searches of one library; times are medians, the build, faiss and the start once."""
    vectors, built = _filled(made)
    read = median_of(partial(read_all, vectors.rows), READS)
    times = _query_seconds(vectors, made)
    return {
        "method": made.layout.method.name,
        "rows": f"{len(made.rows):,} x {made.rows[0].nbytes} bytes",
        "one read, ms": digits(1000 * read),
        "query, ms": digits(1000 * statistics.median(times)),
        "median / read": f"{statistics.median(times) / read:.3f}",
        "95 % / read": f"{np.percentile(times, 95) / read:.3f}",
        "comparing all / read": f"{_everything_seconds(vectors, made) / read:.2f}",
        f"faiss Flat / ours, {BATCH} queries": f"{_faiss_seconds(made) / _batch_seconds(vectors, made):.1f}",
        "wrong answers": f"{_wrong(vectors, made)} of {len(made.queries[:CHECKED])}",
        "sketch / rows": f"{_sketch_bytes(vectors) / vectors.rows.nbytes:.2f}",
        "all memory / rows": f"{_resident(vectors) / vectors.rows.nbytes:.2f}",
        "order and sketch, s": f"{built:.1f}",
        "start from file, s": f"{_start(vectors, made):.1f}",
    }


def size_rows(described: Sequence[Blocks], sizes: Sequence[int] = SIZES) -> Iterator[Row]:
    """Yield what searches cost by the size of the library."""
    for name in NAMES:
        for size in sizes:
            yield size_row(make_rows(described, METHODS[name], size, QUERIES))


def size_row(made: Made) -> Row:
    """Measure single queries and one read."""
    vectors, _ = _filled(made)
    times = _query_seconds(vectors, made)
    return {
        "method": made.layout.method.name,
        "rows": f"{len(made.rows):,}",
        "one read, ms": digits(1000 * median_of(partial(read_all, vectors.rows), READS)),
        "query, ms": digits(1000 * statistics.median(times)),
        "95 %, ms": digits(1000 * float(np.percentile(times, 95))),
    }


def digits(value: float) -> str:
    """Return three digits of a number, or all before the point."""
    return f"{value:.3g}" if value < 999.5 else f"{value:.0f}"


def brute_force(vectors: Vectors, made: Made, query: RowArray) -> Ranked:
    """Return the nearest by comparing all."""
    found = distances(vectors.rows, vectors.here, query, made.layout, made.layout.method)
    worst = np.partition(found, LIMIT - 1)[LIMIT - 1]
    near = sorted((float(found[i]), vectors.ids[i]) for i in np.flatnonzero(found <= worst).tolist())
    return [(shape_id, distance) for distance, shape_id in near[:LIMIT]]


def read_all(rows: RowArray) -> int:
    """Read all bytes of rows once, one after another."""
    flat = rows.reshape(-1).view(np.uint8)
    return _sum(flat[: len(flat) // 8 * 8].view(np.uint64))


def seconds(function: Callable[[], object]) -> float:
    """Return the time that a function takes."""
    start = time.perf_counter()
    function()
    return time.perf_counter() - start


def median_of(function: Callable[[], object], repeats: int) -> float:
    """Return the median time of a function that has run before."""
    function()
    return statistics.median(seconds(function) for _ in range(repeats))


def _filled(made: Made) -> tuple[Vectors, float]:
    """Return vectors of the rows, and how long order and sketch took."""
    vectors = Vectors(made.layout)
    vectors.put([f"{number:032x}" for number in range(len(made.rows))], made.rows)
    built = seconds(vectors.settle)
    rank(vectors, made.queries[0], LIMIT)
    return vectors, built


def _query_seconds(vectors: Vectors, made: Made) -> list[float]:
    return [seconds(partial(rank, vectors, query, LIMIT)) for query in made.queries]


def _batch_seconds(vectors: Vectors, made: Made) -> float:
    return median_of(lambda: [rank(vectors, query, LIMIT) for query in made.queries[:BATCH]], 3)


def _everything_seconds(vectors: Vectors, made: Made) -> float:
    """Return how long comparing all rows with a query takes, by our own distance."""
    layout = made.layout
    return median_of(lambda: distances(vectors.rows, vectors.here, made.queries[0], layout, layout.method), 3)


def _faiss_seconds(made: Made) -> float:
    """Return how long faiss takes for a batch by exact L1 on the same numbers."""
    flat = faiss.IndexFlat(made.layout.width, faiss.METRIC_L1)
    for start in range(0, len(made.rows), BATCH * 1024):
        flat.add(_numbers(made, made.rows[start : start + BATCH * 1024]))
    queries = _numbers(made, made.queries[:BATCH])
    return seconds(lambda: flat.search(queries, LIMIT))


def _numbers(made: Made, rows: RowArray) -> SingleArray:
    if made.layout.packings is None:
        return np.ascontiguousarray(rows)
    places = zip(made.layout.edges, made.layout.edges[1:], made.layout.packings, strict=False)
    return np.hstack([packing.unpack(rows[:, start:end]) for start, end, packing in places])


def _wrong(vectors: Vectors, made: Made) -> int:
    return sum(
        rank(vectors, query, LIMIT) != brute_force(vectors, made, query) for query in made.queries[:CHECKED]
    )


def _sketch_bytes(vectors: Vectors) -> int:
    return sum(array.nbytes for name, array in vectors.arrays().items() if name != "rows")


def _resident(vectors: Vectors) -> int:
    """Return the bytes of rows, sketch and ids: text, a list and a dictionary with its numbers."""
    ids = sum(89 for _ in vectors.ids)  # a str of 32 letters with its place in the list
    return vectors.rows.nbytes + _sketch_bytes(vectors) + ids + 118 * len(vectors)


def _start(vectors: Vectors, made: Made) -> float:
    """Return how long it takes to load vectors from a file and answer a first query."""
    header = Header(
        library="", epoch=0, vocabulary_id=None, blocks=[], lengths=list(made.layout.lengths),
        ids=list(vectors.ids), revisions=[1] * len(vectors),
    )  # fmt: skip
    with tempfile.TemporaryDirectory() as folder:
        save_index(LocalFiles(Path(folder)), "index", header, vectors.arrays())

        def start() -> None:
            found, arrays = load_index(Path(folder) / "index")
            rank(Vectors.restored(made.layout, found.ids, arrays), made.queries[0], LIMIT)

        return seconds(start)


@compiled
def _sum(words: "np.ndarray[tuple[int], np.dtype[np.uint64]]") -> int:
    sums = np.zeros(32, np.uint64)  # lanes, so that the processor waits for memory alone
    for start in range(0, len(words) - 31, 32):
        some = words[start : start + 32]
        for lane in range(32):
            sums[lane] += some[lane]
    return int(sums.sum())


if __name__ == "__main__":
    main()
