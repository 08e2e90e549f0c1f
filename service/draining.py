"""A server that, told to end, first says so to whoever balances the load, and answers for a while."""

import logging
import time
from collections.abc import Callable
from types import FrameType

import uvicorn

from service.http.dependencies import Services

log = logging.getLogger(__name__)


class DrainingServer(uvicorn.Server):
    """Answers ``/readyz`` with 503 from the first signal on, and ends after some time; a second one ends it.

    Parameters
    ----------
    config : uvicorn.Config
    seconds : float
        From the signal until no new connection is taken; 0: none.
    services : callable
        Returns what the application opened; asked only once it has started.
    """

    def __init__(self, config: uvicorn.Config, seconds: float, services: Callable[[], Services]) -> None:
        super().__init__(config)
        self._seconds, self._services = seconds, services
        self._signal: int | None = None  # the first
        self._retired = False
        self._end = float("inf")  # by the monotonic clock

    def handle_exit(self, sig: int, frame: FrameType | None) -> None:
        """Note the first signal; nothing that waits for a lock may happen here."""
        first = self._signal is None
        self._signal = sig
        if self.started:
            self._services().readiness.shutting_down = True
        if first and self.started and self._seconds:
            self._end = time.monotonic() + self._seconds
        else:
            super().handle_exit(sig, frame)

    async def on_tick(self, counter: int) -> bool:
        """End when the time has come."""
        if self._signal is not None and not self._retired:
            self._retired = True
            log.info("told to end: requests are still answered for %g s", self._seconds)
            self._services().retire()
        if self._signal is not None and not self.should_exit and time.monotonic() >= self._end:
            super().handle_exit(self._signal, None)
        return await super().on_tick(counter)
