"""Which request, job and shape the code at work here is about, so that every line of the log can say so."""

import contextlib
from collections.abc import Iterator, Mapping
from contextvars import ContextVar
from types import MappingProxyType

_known: ContextVar[Mapping[str, object]] = ContextVar("known", default=MappingProxyType({}))


@contextlib.contextmanager
def known_as(**ids: object) -> Iterator[None]:
    """Add ids inside the block, in this context and what is copied of it.

    Parameters
    ----------
    **ids
        ``request_id``, ``job_id``, ``shape_id``, ``trace_id``; None is left out.
    """
    token = _known.set({**_known.get(), **{name: each for name, each in ids.items() if each is not None}})
    try:
        yield
    finally:
        _known.reset(token)


def known() -> Mapping[str, object]:
    """Return the ids of whatever is at work here."""
    return _known.get()
