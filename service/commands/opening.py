"""Libraries and workers for the length of one command."""

import contextlib
import threading
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from service.commands.failures import CommandFailed
from service.jobs.executors import child_limits, start_computing
from service.jobs.pool import ProcessPerJob
from service.jobs.workers import Worker, process_name
from service.library import Library
from service.settings import Settings


@dataclass(frozen=True, kw_only=True)
class Helper:
    """A worker beside a command."""

    wake: Callable[[], None]  # tells it of a new job
    settled: threading.Event  # set whenever it has ended a job
    slots: Callable[[], int]  # jobs that it does at the same time, now


def settings_for(data_dir: Path, **changes: Any) -> Settings:
    """Return the settings of the environment, with those given on the command line."""
    given = {name: value for name, value in changes.items() if value is not None}
    return Settings(data_dir=data_dir, **given)


@contextlib.contextmanager
def opened(settings: Settings, *, make: bool = False) -> Iterator[Library]:
    """Open a library; without ``make`` it must exist already.

    Raises
    ------
    CommandFailed
        There is none.
    """
    if not make and settings.database_url is None and not settings.data_dir.is_dir():
        raise CommandFailed(f"there is no library at {settings.data_dir}; `faience index PATH` makes one")
    library = Library.open(settings)
    try:
        yield library
    finally:
        library.close()


@contextlib.contextmanager
def pool_for(settings: Settings, preload: Sequence[str] = ()) -> Iterator[ProcessPerJob]:
    """Start the processes that describe meshes; kill those that still run at the end."""
    pool = ProcessPerJob(slots=max(settings.workers, 1), limits=child_limits(settings), preload=preload)
    pool.warm()
    try:
        yield pool
    finally:
        pool.shutdown(cancel_futures=True)


@contextlib.contextmanager
def working(library: Library) -> Iterator[Helper]:
    """Work on the queue beside the command.

    Jobs that are not finished at the end go back to the queue.
    """
    computing = start_computing(library.settings, max(library.settings.workers, 1))
    settled = threading.Event()
    worker = Worker(
        library,
        computing.executor,
        slots=computing.slots,
        name=process_name(),
        observe=lambda *_: settled.set(),
    )
    thread = threading.Thread(target=worker.run, name="worker")
    thread.start()
    try:
        yield Helper(wake=worker.wake, settled=settled, slots=computing.slots)
    finally:
        worker.stop()
        computing.executor.shutdown(cancel_futures=True)
        thread.join()
