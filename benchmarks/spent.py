"""Spent: processor time of this process and of its PostgreSQL backend, whatever else the machine does."""

import time
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

from sqlalchemy import Engine, text

Result = TypeVar("Result")


class Spending:
    """Measures calls that use one connection of an engine, to a server on this machine.

    Parameters
    ----------
    engine : Engine
        Whose connections are used one at a time, so that there is one backend. It gets no help from others.
    """

    def __init__(self, engine: Engine) -> None:
        with engine.begin() as connection:
            for setting in ("max_parallel_workers_per_gather", "max_parallel_maintenance_workers"):
                connection.execute(text(f"SET {setting} = 0"))
            backend = connection.scalar(text("SELECT pg_backend_pid()"))
        self._path = Path(f"/proc/{backend}/schedstat")

    def of(self, function: Callable[[], Result]) -> tuple[Result, float]:
        """Return what a function returns, and the seconds of processor time that it took."""
        before = self._now()
        result = function()
        return result, self._now() - before

    def _now(self) -> float:
        nanoseconds = int(self._path.read_text().split()[0])  # on a processor, so far
        return time.process_time() + nanoseconds / 1e9
