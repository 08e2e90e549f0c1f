"""Measure what Faience costs, and fill docs/speed.md. Run by `make bench`.

Each table is written as soon as it is measured; a stopped run keeps what it had.
"""

import argparse
import os
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import faiss
from threadpoolctl import threadpool_limits

from benchmarks import eigenpairs, from_file, http_overhead, searching
from benchmarks.made_rows import Blocks, described_blocks
from benchmarks.measured import as_table, keep_measured
from benchmarks.pages import Row, fill_page
from benchmarks.speed_plot import speed_plot
from worker.parameters import Parameters

DOCS = Path(__file__).parents[1] / "docs"


@dataclass(frozen=True, kw_only=True)
class Extent:
    """How much is measured."""

    data: Sequence[Path] = ()  # the user's meshes
    repeats: int = 3
    vertices: int = eigenpairs.SIZE  # where ours and the naive way are compared
    resolutions: Sequence[int] = eigenpairs.SIZES
    counted: int = eigenpairs.MADE  # made shapes whose pairs are counted
    inputs: Sequence[int] = from_file.SIZES  # vertices in
    described: int = searching.DESCRIBED  # shapes of which rows are made
    rows: int = searching.ROWS
    libraries: Sequence[int] = searching.SIZES  # rows
    shapes: int = http_overhead.SHAPES
    requests: int = http_overhead.REQUESTS


TINY = Extent(
    repeats=1,
    vertices=1_000,
    resolutions=(1_000, 2_000),
    counted=2,
    inputs=(1_000, 2_000),
    described=4,
    rows=20_000,
    libraries=(1_000, 10_000),
    shapes=120,
    requests=50,
)


def main() -> None:
    """Measure what is wanted, one table after another."""
    options = _options()
    os.environ["OMP_NUM_THREADS"] = "1"  # for the processes that are started
    faiss.omp_set_num_threads(1)
    extent = replace(TINY if options.tiny else Extent(), data=options.data)
    with threadpool_limits(1):
        for name in options.only:
            start = time.perf_counter()
            rows = list(TABLES[name](extent))
            if rows:
                write(options.docs, name, rows)
            print(f"{name}: {time.perf_counter() - start:.0f} s", *rows, sep="\n  ", flush=True)


def write(docs: Path, name: str, rows: Sequence[Row]) -> None:
    """Keep a table, fill it in, and draw the plot anew."""
    measured = keep_measured(docs / "speed.json", name, rows)
    fill_page(docs / "speed.md", {name: as_table(measured[name])})
    (docs / "speed.svg").write_text(speed_plot(measured), encoding="utf-8")


def eigen_rows(extent: Extent) -> Iterator[Row]:
    """Yield the eigen part against the naive way."""
    return eigenpairs.comparison_rows(eigenpairs.sample_surface(extent.vertices), extent.repeats)


def pair_rows(extent: Extent) -> Iterator[Row]:
    """Yield how many pairs are found, against the inertia: in made shapes, and in those given."""
    uploads = {f"{extent.counted} made": eigenpairs.made_uploads(extent.counted)}
    if extent.data:
        uploads["given"] = eigenpairs.file_uploads(extent.data)
    for name, files in uploads.items():
        found = eigenpairs.count_pairs(files, Parameters())
        yield {
            "shapes": name,
            "described": f"{found.meshes:,}",
            "spectra": f"{found.spectra:,}",
            "pairs": f"{found.pairs:,}",
            "spectra with more or fewer": f"{found.differing:,}",
        }


def core_rows(extent: Extent) -> Iterator[Row]:
    """Yield shapes a second by workers, where meshes are given."""
    return from_file.index_rows(extent.data, extent.repeats) if extent.data else iter(())


@cache
def blocks_of(described: int) -> Sequence[Blocks]:
    """Describe made shapes once for both tables of searches."""
    return described_blocks(described)


TABLES: Mapping[str, Callable[[Extent], Iterator[Row]]] = {
    "eigen": eigen_rows,
    "eigen-sizes": lambda extent: eigenpairs.size_rows(extent.resolutions),
    "pairs": pair_rows,
    "job": lambda extent: from_file.whole_rows(extent.repeats),
    "stages": lambda extent: from_file.stage_rows(extent.repeats),
    "job-sizes": lambda extent: from_file.size_rows(extent.inputs, extent.repeats),
    "cores": core_rows,
    "search": lambda extent: searching.search_rows(blocks_of(extent.described), extent.rows),
    "search-sizes": lambda extent: searching.size_rows(blocks_of(extent.described), extent.libraries),
    "http": lambda extent: iter(http_overhead.rows(extent.shapes, extent.requests)),
}


def _options() -> argparse.Namespace:
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("data", nargs="*", type=Path, help="meshes, for the tables `pairs` and `cores`")
    arguments.add_argument("--only", type=_names, default=tuple(TABLES), help="tables, separated by commas")
    arguments.add_argument("--tiny", action="store_true", help="tiny sizes, to see whether all runs")
    arguments.add_argument("--docs", type=Path, default=DOCS, help="folder of speed.md, .json and .svg")
    return arguments.parse_args()


def _names(text: str) -> tuple[str, ...]:
    found = tuple(text.split(","))
    if not set(found) <= set(TABLES):
        raise argparse.ArgumentTypeError(f"tables are {', '.join(TABLES)}; not {text!r}")
    return found


if __name__ == "__main__":
    main()
