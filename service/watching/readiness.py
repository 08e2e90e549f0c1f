"""Whether the service can serve: each part is asked, none for longer than its time, once for all callers."""

import logging
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

log = logging.getLogger(__name__)

OK = "ok"
KEPT_SECONDS = 1.0  # for which an answer holds
BAD_PART = 0.1  # of that time for which a bad one does: what is well again, or loaded, is soon seen


class NotWell(Exception):
    """A part cannot serve; the message says why, without secrets."""


class Unready(Exception):
    """At least one part cannot serve."""

    code = "unready"

    def __init__(self, parts: Mapping[str, str]) -> None:
        bad = [f"{name} {words}" for name, words in parts.items() if words != OK]
        super().__init__("; ".join(bad))
        self.members = {"parts": dict(parts)}  # of the problem


class ShuttingDown(Exception):
    """The service was told to end, and still answers for a while."""

    code = "shutting_down"


@dataclass(frozen=True, kw_only=True)
class Check:
    """One part."""

    name: str  # stable; operators' tools may rely on it
    run: Callable[[], None]  # raises NotWell, or anything else, where the part cannot serve
    seconds: float = 2.0  # after which it counts as not answering


class Readiness:
    """Looks after the parts of one service.

    Parameters
    ----------
    checks : sequence of Check
        Parts without which nothing can be served.
    told : mapping of str to callable
        Parts that are told of in words, and do not matter for the answer.
    kept_seconds : float, optional
        For which an answer holds; a second by default.
    """

    def __init__(
        self,
        checks: Sequence[Check],
        told: Mapping[str, Callable[[], str]] | None = None,
        *,
        kept_seconds: float | None = None,
    ) -> None:
        self._asked = [_Asked(check) for check in checks]
        self._told = told or {}
        self._kept_seconds = KEPT_SECONDS if kept_seconds is None else kept_seconds
        self._lock = threading.Lock()
        self._parts: dict[str, str] = {}
        self._until = -float("inf")  # by the monotonic clock
        self.shutting_down = False  # set where the process is told to end

    def look(self) -> dict[str, str]:
        """Return each part and ``ok``, or what is told of it.

        Raises
        ------
        Unready, ShuttingDown
        """
        if self.shutting_down:
            raise ShuttingDown("this process was told to end; ask another")
        parts = self._of_checks()
        if any(words != OK for words in parts.values()):
            raise Unready(parts)
        return parts | {name: words() for name, words in self._told.items()}

    def _of_checks(self) -> dict[str, str]:
        with self._lock:
            if time.monotonic() >= self._until:
                for asked in self._asked:
                    asked.begin()
                self._note({asked.check.name: asked.words() for asked in self._asked})
                well = all(words == OK for words in self._parts.values())
                self._until = time.monotonic() + self._kept_seconds * (1 if well else BAD_PART)
            return dict(self._parts)

    def _note(self, parts: dict[str, str]) -> None:
        """Keep what was found; the log hears of changes alone."""
        for name, words in parts.items():
            if words != self._parts.get(name, OK):
                log.warning("%s %s", name, words if words != OK else "is well again")
        self._parts = parts


class _Asked:
    """A check in a thread of its own, so that one that hangs holds up nobody, and is not asked again."""

    def __init__(self, check: Check) -> None:
        self.check = check
        self._done = threading.Event()
        self._done.set()
        self._found = OK
        self._began = 0.0  # by the monotonic clock

    def begin(self) -> None:
        if not self._done.is_set():
            return
        self._done.clear()
        self._began = time.monotonic()
        threading.Thread(target=self._run, name=f"check {self.check.name}", daemon=True).start()

    def words(self) -> str:
        left = self._began + self.check.seconds - time.monotonic()
        if self._done.wait(max(left, 0.0)):
            return self._found
        return f"has not answered for {time.monotonic() - self._began:.0f} s"

    def _run(self) -> None:
        try:
            self.check.run()
            self._found = OK
        except NotWell as error:
            self._found = str(error)
        except Exception as error:
            log.warning("the check of %s failed: %s", self.check.name, type(error).__name__, exc_info=error)
            self._found = "cannot be used at the moment; the log says more"
        finally:
            self._done.set()
