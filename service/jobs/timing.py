"""How long each stage of a job took, taken where the job runs and brought back with its value."""

import contextlib
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from worker.stages import observed

Value = TypeVar("Value")


@dataclass(frozen=True, kw_only=True)
class Stage:
    """One stretch of a job."""

    name: str
    began: float  # seconds since 1970, by the clock of the machine that did it
    seconds: float


@dataclass(frozen=True, kw_only=True)
class Timed(Generic[Value]):
    """What a function returned, and how it spent its time."""

    value: Value
    stages: tuple[Stage, ...]  # in the order of their ends; a name may come more than once


def timed(function: Callable[..., Value], *args: Any) -> Timed[Value]:
    """Call ``function(*args)`` and note the stages that it tells through `worker.stages`."""
    stages: list[Stage] = []

    @contextlib.contextmanager
    def note(name: str) -> Iterator[None]:
        with timing(name, stages):
            yield

    with observed(note):
        value = function(*args)
    return Timed(value=value, stages=tuple(stages))


@contextlib.contextmanager
def timing(name: str, stages: list[Stage]) -> Iterator[None]:
    """Append how long the block took, whether or not it succeeded."""
    began, start = time.time(), time.perf_counter()
    try:
        yield
    finally:
        stages.append(Stage(name=name, began=began, seconds=time.perf_counter() - start))
