"""What a library of so many shapes takes, by multiplying what one shape takes; no table of prices."""

from collections.abc import Callable, Iterator, Mapping

SIZES = (100_000, 10_000_000, 100_000_000)  # shapes
DESCRIBING = (1.0, 1.4)  # CPU seconds of a description
FILES, UPLOAD = 0.75e6, 0.15e6  # bytes: what is derived, and a small upload; scans are larger
CATALOGUE = 17e3  # bytes of a shape in PostgreSQL: 12.6 kB of blocks, its row, their keys
MEMORY = 1_090  # bytes of a shape in each process that searches by `fused` in memory: see docs/speed.md
TABLE, GRAPH = 2_930, 2_050  # bytes of a shape in pgvector by `fused`: its row; its place in a graph
SCAN = 1.1e-6  # CPU seconds for a row of `fused` in pgvector
HOUR, DAY = 3_600, 86_400

Row = Mapping[str, str]  # column → cell


def arithmetic() -> Iterator[Row]:
    """Yield one row for each thing that a library takes, with a column for each size."""
    for thing, of in _THINGS.items():
        yield {"": thing, **{f"{size:,} shapes": of(size) for size in SIZES}}


def size_of(n_bytes: float) -> str:
    """Return bytes in the unit that fits, to two digits."""
    for unit, name in ((1e12, "TB"), (1e9, "GB")):
        if n_bytes >= unit:
            return f"{float(f'{n_bytes / unit:.2g}'):g} {name}"
    return f"{float(f'{n_bytes / 1e6:.2g}'):g} MB"


def count_of(number: float) -> str:
    """Return a number to two digits, with separators."""
    return f"{float(f'{number:.2g}'):,g}" if number < 1e6 else f"{number / 1e6:.2g} million"


def _core_hours(n_shapes: int) -> str:
    low, high = (count_of(seconds * n_shapes / HOUR) for seconds in DESCRIBING)
    return f"{low} to {high}"


def _cores(n_shapes: int) -> str:
    low, high = (count_of(max(1.0, seconds * n_shapes / (30 * DAY))) for seconds in DESCRIBING)
    return f"{low} to {high}" if low != high else low


_THINGS: Mapping[str, Callable[[int], str]] = {
    "describing, core-hours": _core_hours,
    "cores, to describe all in 30 days": _cores,
    "derived files (GB-months for each month)": lambda n: size_of(FILES * n),
    "uploads of 0.15 MB": lambda n: size_of(UPLOAD * n),
    "catalogue in PostgreSQL": lambda n: size_of(CATALOGUE * n),
    "`memory`: memory of each process, `fused`": lambda n: size_of(MEMORY * n),
    "`pgvector`: table of `fused`": lambda n: size_of(TABLE * n),
    "`pgvector`: core-seconds a query": lambda n: count_of(SCAN * n),
    "`pgvector-hnsw`: graph of `fused`": lambda n: size_of(GRAPH * n),
}
