"""How many meshes the holder of one key may send in a minute."""

import math
import time

from limits import RateLimitItemPerMinute
from limits.storage import MemoryStorage
from limits.strategies import MovingWindowRateLimiter


class TooManyUploads(Exception):
    """One key sent more uploads than the service takes in a minute."""

    code = "too_many_uploads"

    def __init__(self, message: str, wait: int) -> None:
        super().__init__(message)
        self.headers = {"Retry-After": str(wait)}


class UploadRate:
    """Counts uploads by key, each for the minute after it came; those refused are not counted.

    It counts in memory: a restart forgets, and several services beside each other count apart.

    Parameters
    ----------
    per_minute : int
        Uploads of one key in any 60 seconds; 0: as many as come.
    """

    def __init__(self, per_minute: int) -> None:
        self._most = RateLimitItemPerMinute(per_minute) if per_minute else None
        self._window = MovingWindowRateLimiter(MemoryStorage())

    def count(self, identity: str) -> None:
        """Count one upload.

        Raises
        ------
        TooManyUploads
            With the seconds after which the next one is taken.
        """
        if self._most is None or self._window.hit(self._most, identity):
            return
        free_at = self._window.get_window_stats(self._most, identity).reset_time
        wait = max(1, math.ceil(free_at - time.time()))
        raise TooManyUploads(
            f"this key may send {self._most.amount} uploads a minute; the next one is taken in {wait} s", wait
        )
