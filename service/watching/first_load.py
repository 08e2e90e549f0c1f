"""The index of the first search is loaded at the start, so that no query waits for it after a restart."""

import contextlib
import logging
import threading
from collections.abc import Iterator

from index.methods import DEFAULT_METHOD
from service.library import Library

log = logging.getLogger(__name__)


class FirstLoad:
    """Loads the default method's index beside the start."""

    def __init__(self, library: Library) -> None:
        self._library = library
        self._done = threading.Event()

    @property
    def done(self) -> bool:
        """Whether it is over, well or not: a search says better what is wrong."""
        return self._done.is_set()

    @contextlib.contextmanager
    def running(self) -> Iterator[None]:
        """Load in a thread; the start does not wait for it, the end does."""
        thread = threading.Thread(target=self._load, name="first load")
        thread.start()
        try:
            yield
        finally:
            thread.join()

    def _load(self) -> None:
        try:
            self._library.searcher.load(DEFAULT_METHOD)
        except Exception:  # the first search tries again
            log.exception("the index could not be loaded at the start")
        finally:
            self._done.set()
