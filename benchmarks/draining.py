"""What the queue itself costs: thousands of jobs claimed and recorded, with nothing to compute.

`python -m benchmarks.draining --rows 10000`; on SQLite, and on a PostgreSQL server of its own.
"""

import argparse
import multiprocessing
import statistics
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from sqlalchemy import insert, make_url

from benchmarks.pages import table_of
from index.database import writing
from index.revisions import lock_state, now
from index.shapes import Status
from index.tables import JobRow, ShapeRow
from tests.catalogues import FINGERPRINT, HISTOGRAM, WORDS, Opened, open_catalogue
from tests.databases import DATABASES, KINDS, postgresql

LEASE = 600.0  # seconds; nothing runs out meanwhile


@dataclass(frozen=True, kw_only=True)
class Drained:
    """What one claimer did."""

    claims: list[float]  # seconds each
    records: list[float]
    shapes: list[str]


def fill(opened: Opened, n_rows: int) -> None:
    """Queue so many shapes, quicker than by accepting each."""
    with writing(opened.engine) as session:
        first = lock_state(session).revision + 1
        ids = [f"s{number:06}" for number in range(n_rows)]
        session.execute(insert(ShapeRow), [_shape(shape_id, first + n) for n, shape_id in enumerate(ids)])
        queued = {"attempts": 0, "queued_at": now()}
        session.execute(insert(JobRow), [{"shape_id": shape_id, **queued} for shape_id in ids])
        lock_state(session).revision += n_rows


def _shape(shape_id: str, revision: int) -> dict[str, object]:
    moment = now()
    return {
        "id": shape_id,
        "name": shape_id,
        "status": Status.QUEUED,
        "created_at": moment,
        "updated_at": moment,
        "user_metadata": {},
        "sha256": f"sum of {shape_id}",
        "revision": revision,
        "sequence": revision,
        "searchable": shape_id,
        "allow_untextured": False,
    }


def drain(folder: Path, kind: str, worker: str) -> Drained:
    """Claim and record until nothing is left."""
    DATABASES.kind = kind
    opened = open_catalogue(folder)
    claims, records, shapes = [], [], []
    while True:
        start = time.perf_counter()
        job = opened.queue.claim(worker, LEASE)
        claimed = time.perf_counter()
        if job is None:
            break
        opened.catalogue.record_ready(
            job,
            facts={},
            fingerprint=FINGERPRINT,
            blocks=HISTOGRAM,
            quantised=WORDS,
            vocabulary_id=opened.vocabulary_id,
        )
        claims.append(claimed - start)
        records.append(time.perf_counter() - claimed)
        shapes.append(job.shape_id)
    opened.engine.dispose()
    return Drained(claims=claims, records=records, shapes=shapes)


def measure(kind: str, n_rows: int, claimers: int) -> dict[str, str]:
    """Drain a new queue; return a row of the table."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        opened = open_catalogue(folder)
        fill(opened, n_rows)
        opened.engine.dispose()
        start = time.perf_counter()
        with multiprocessing.get_context("spawn").Pool(claimers) as pool:
            answers = pool.starmap(drain, [(folder, kind, f"w{number}") for number in range(claimers)])
        seconds = time.perf_counter() - start
    shapes = [shape for answer in answers for shape in answer.shapes]
    return {
        "database": kind,
        "claimers": str(claimers),
        "jobs": str(len(shapes)),
        "doubled": str(len(shapes) - len(set(shapes))),
        "claim, ms": _median([one for answer in answers for one in answer.claims]),
        "record, ms": _median([one for answer in answers for one in answer.records]),
        "jobs a second": f"{len(shapes) / seconds:.0f}",
    }


def _median(seconds: Sequence[float]) -> str:
    return f"{1000 * statistics.median(seconds):.2f}"


@contextmanager
def database(kind: str) -> Iterator[None]:
    """Have catalogues kept in a kind of database while the block runs."""
    with tempfile.TemporaryDirectory() as folder:
        if kind == "sqlite":
            yield
            return
        with postgresql(Path(folder) / "data") as address:
            DATABASES.server, DATABASES.kind = make_url(address).render_as_string(hide_password=False), kind
            yield
            DATABASES.kind = "sqlite"


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rows", type=int, default=10_000)
    parser.add_argument("--claimers", type=int, nargs="+", default=[1, 4])
    parser.add_argument("--databases", choices=KINDS, nargs="+", default=KINDS)
    arguments = parser.parse_args()
    rows = []
    for kind in arguments.databases:
        with database(kind):
            rows += [measure(kind, arguments.rows, claimers) for claimers in arguments.claimers]
    print(table_of(rows))


if __name__ == "__main__":
    main()
