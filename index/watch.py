"""What a search tells of itself while it runs; nobody listens unless `watched` says who."""

import contextlib
from collections.abc import Iterator
from contextlib import AbstractContextManager, nullcontext
from contextvars import ContextVar


class Watch:
    """Hears of searches; this one does nothing with what it hears."""

    def stage(self, name: str, method: str) -> AbstractContextManager[object]:  # noqa: ARG002 - for others
        """Return the context of one stage of a search by a method."""
        return nullcontext()

    def compared(self, method: str, rows: int, of: int, escalated: bool) -> None:
        """Hear how many rows were compared exactly.

        Parameters
        ----------
        rows : int
            Compared in double precision; a row that was compared twice counts twice.
        of : int
            Rows that the index holds; 0 where that is not known.
        escalated : bool
            Whether the first limits left so many rows that another limit was looked for.
        """


_watch: ContextVar[Watch] = ContextVar("watch", default=Watch())  # noqa: B039 - it holds nothing


def stage(name: str, method: str) -> AbstractContextManager[object]:
    """Return the context of one stage of a search, as its watch made it."""
    return _watch.get().stage(name, method)


def tell_compared(method: str, rows: int, of: int, escalated: bool) -> None:
    """Tell the watch what `Watch.compared` says."""
    _watch.get().compared(method, rows, of, escalated)


@contextlib.contextmanager
def watched(watch: Watch) -> Iterator[None]:
    """Let a watch hear of the searches inside the block, in this context and what is copied of it."""
    token = _watch.set(watch)
    try:
        yield
    finally:
        _watch.reset(token)
