"""How many meshes may be described for queries at once: a bounded queue before the pool."""

import contextlib
import threading
from collections.abc import Iterator


class TooBusy(Exception):
    """As many searches wait as may; come back in a moment."""

    code = "too_busy"


class Turnstile:
    """Lets a bounded number in; the others are refused at once, so that no thread waits for long.

    Parameters
    ----------
    places : int
        How many may be inside.
    """

    def __init__(self, places: int) -> None:
        self._places = threading.BoundedSemaphore(places)

    @contextlib.contextmanager
    def enter(self) -> Iterator[None]:
        """Take a place; TooBusy where none is free."""
        if not self._places.acquire(blocking=False):
            raise TooBusy("too many searches are waiting; try again in a moment")
        try:
            yield
        finally:
            self._places.release()
