"""Worker processes side by side: as quick together as one with as many children, and no job done twice.

`python -m benchmarks.claimers --shapes 40`; on SQLite, and on a PostgreSQL server of its own.
"""

import argparse
import contextlib
import tempfile
from collections.abc import Sequence
from pathlib import Path

from sqlalchemy import select

from benchmarks.draining import database
from benchmarks.pages import Row, table_of
from index.database import reading
from index.shapes import Status
from index.tables import FinishedJobRow
from service.intake.submissions import receive_paths
from service.library import Library
from service.retrieval import accept_upload
from service.samples import random_creatures
from service.settings import Settings
from soak.processes import Command, ending, wait_until
from tests.databases import DATABASES, KINDS

SEED = 7
ARRANGEMENTS = ((4,), (1, 1), (1, 1, 1, 1))  # `--workers` of each process


def fill(library: Library, n_shapes: int) -> None:
    """Queue made shapes, each with its picture or colours."""
    for number, sample in enumerate(random_creatures(n_shapes, SEED)):
        folder = library.incoming.folder / str(number)
        folder.mkdir()
        for name, content in sample.files.items():
            (folder / name).write_bytes(content)
        paths = {name: folder / name for name in sample.files}
        accept_upload(library, receive_paths(paths, name=str(number)))


def measure(kind: str, n_shapes: int, processes: Sequence[int]) -> Row:
    """Have a new library described by worker processes; return a row of the table."""
    with tempfile.TemporaryDirectory() as name, contextlib.ExitStack() as stack:
        folder = Path(name)
        settings = Settings(data_dir=folder, database_url=DATABASES.url(folder))
        library = Library.open(settings)
        stack.callback(library.close)
        fill(library, n_shapes)
        commands = [
            Command(
                ("worker", "--workers", str(each), "--data-dir", name), {"FAIENCE_DATABASE_URL": settings.url}
            )
            for each in processes
        ]
        with ending(*commands):
            for command in commands:
                command.start()
            wait_until(lambda: library.catalogue.counts()[Status.READY] == n_shapes)
        with reading(library.engine) as session:
            ends = list(
                session.scalars(select(FinishedJobRow.finished_at).order_by(FinishedJobRow.finished_at))
            )
        seconds = (ends[-1] - ends[0]).total_seconds()  # the start is not counted
    return {
        "database": kind,
        "processes": str(len(processes)),
        "workers in each": str(processes[0]),
        "jobs": str(n_shapes),
        "ends": str(len(ends)),  # one for each job, or some were done twice
        "meshes a minute": f"{60 * (len(ends) - 1) / seconds:.0f}",
    }


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--shapes", type=int, default=40)
    parser.add_argument("--databases", choices=KINDS, nargs="+", default=KINDS)
    arguments = parser.parse_args()
    rows = []
    for kind in arguments.databases:
        with database(kind):
            rows += [measure(kind, arguments.shapes, each) for each in ARRANGEMENTS]
    print(table_of(rows))


if __name__ == "__main__":
    main()
