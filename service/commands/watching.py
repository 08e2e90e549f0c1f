"""A progress bar for what a service in the same process is doing."""

import contextlib
import threading
from collections.abc import Iterator

from index.shapes import Status
from service.commands.opening import opened
from service.commands.progress import progress_bar
from service.settings import Settings

LOOK_EVERY = 0.2  # seconds


@contextlib.contextmanager
def watching(settings: Settings, title: str, total: int) -> Iterator[None]:
    """Show how many shapes of a library that was empty are described, while the block runs."""
    stop = threading.Event()
    thread = threading.Thread(target=_watch, args=(settings, title, total, stop))
    thread.start()
    try:
        yield
    finally:
        stop.set()
        thread.join()


def _watch(settings: Settings, title: str, total: int, stop: threading.Event) -> None:
    with opened(settings) as library, progress_bar(title, total) as advance:
        done = 0
        while done < total and not stop.wait(LOOK_EVERY):
            counts = library.catalogue.counts()
            done = counts[Status.READY] + counts[Status.FAILED]
            advance(completed=min(done, total), total=total)
