"""Where a description has come to, told to whoever asked; nothing is measured here."""

import contextlib
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, nullcontext
from contextvars import ContextVar

Observer = Callable[[str], AbstractContextManager[object]]  # entered with a stage's name, left at its end

_observer: ContextVar[Observer] = ContextVar("observer", default=nullcontext)

READ = "read"  # the upload's bytes become a mesh
REPAIR = "repair"  # and resampling, and the colours
SPECTRUM = "spectrum"  # operators and their eigenpairs
DESCRIPTORS = "descriptors"
PICTURES = "pictures"
STAGES = READ, REPAIR, SPECTRUM, DESCRIPTORS, PICTURES


def stage(name: str) -> AbstractContextManager[object]:
    """Return the context of one stage; stages do not overlap, and one may come more than once."""
    return _observer.get()(name)


@contextlib.contextmanager
def observed(observer: Observer) -> Iterator[None]:
    """Let an observer hear of the stages inside the block, in this thread."""
    token = _observer.set(observer)
    try:
        yield
    finally:
        _observer.reset(token)
