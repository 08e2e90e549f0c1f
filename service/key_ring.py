"""The keys that open a running service: those of its start, and those of its library as they come and go."""

import contextlib
import hmac
import logging
import secrets
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from index.key_secrets import digest_of, id_in
from index.keys import ActiveKey
from index.scopes import Scope
from service.settings import Settings, is_loopback

log = logging.getLogger(__name__)

ENVIRONMENT = "environment"  # name of every key that came with the start
LOOK_EVERY = 1.0  # seconds between two looks at the library's keys
PATIENCE = 60.0  # seconds for which the last look still counts


class Unauthorised(Exception):
    """No key, or one that is not known."""

    code = "unauthorised"


class KeysUnreadable(Exception):
    """The library's keys could not be read for too long to go on with those last seen."""

    code = "keys_unreadable"


@dataclass(frozen=True, kw_only=True)
class Holder:
    """Who sent a request."""

    identity: str  # of the key, the same with every request; not the key itself
    scope: Scope
    name: str = ""  # whose key it is, for the log


@dataclass(frozen=True, kw_only=True)
class _Look:
    """What was seen of the library's keys at one moment; replaced as a whole, so that no lock is needed."""

    keys: Mapping[str, ActiveKey] = field(repr=False)  # by id
    demanded: bool  # whether requests need a key
    at: float  # seconds of the monotonic clock


class KeyRing:
    """Tells who holds a key, without asking the database for each request.

    Where neither the start nor the library has a key, a service for this machine alone is open. Once it has
    demanded keys, it does so until it ends: revoking the last key closes the doors, never opens them.

    Parameters
    ----------
    settings : Settings
        With the keys of the environment, which allow everything.
    active : callable
        Reads the library's keys.
    patience : float
        Seconds for which keys once seen open while they cannot be read again.
    """

    def __init__(
        self, settings: Settings, active: Callable[[], Sequence[ActiveKey]], *, patience: float = PATIENCE
    ) -> None:
        self._given = tuple(
            ActiveKey(id=f"given:{digest.hex()[:16]}", digest=digest, scope=Scope.WRITE, name=ENVIRONMENT)
            for digest in settings.key_digests
        )
        self._nobody = ActiveKey(id="", digest=secrets.token_bytes(32), scope=Scope.READ)
        self._active, self._patience = active, patience
        self._for_others = not settings.insecure and not is_loopback(settings.host)
        self._readable = True  # whether the last look succeeded
        self._look = self._looked(demanded=bool(self._given) or self._for_others)

    @property
    def demanded(self) -> bool:
        """Whether requests need a key."""
        return self._look.demanded

    @property
    def readable(self) -> bool:
        """Whether the library's keys were read lately enough to go by them."""
        return time.monotonic() - self._look.at <= self._patience

    def holder_of(self, secret: bytes | None) -> Holder | None:
        """Return whose key a request brought; None where none is needed.

        Every comparison takes the same time, whether the key is known or not.

        Raises
        ------
        Unauthorised
            A key is needed, and this is none that opens.
        KeysUnreadable
            Whether it opens cannot be said.
        """
        look = self._look
        sent = digest_of(secret or b"")
        compared = (*self._given, look.keys.get(id_in(secret or b""), self._nobody))
        found = [key for key in compared if hmac.compare_digest(sent, key.digest)]
        if found and found[0] in self._given:
            return _holder(found[0])
        if time.monotonic() - look.at > self._patience:
            raise KeysUnreadable("the library's keys cannot be read at the moment; try again soon")
        if found:
            return _holder(found[0])
        if look.demanded:
            raise Unauthorised(
                "send a known key in the header `Authorization: Bearer …`; `faience key create` makes one"
            )
        return None

    def welcomes(self, holder: Holder | None) -> bool:
        """Return whether someone let in earlier would be let in now: for answers that go on for long."""
        look = self._look
        if holder is None:
            return not look.demanded
        return holder.identity in look.keys or any(key.id == holder.identity for key in self._given)

    def look_again(self) -> None:
        """Read the library's keys; where that fails, the last look goes on for its time."""
        try:
            self._look = self._looked(demanded=self._look.demanded)
        except Exception:  # whatever the reason, the guard must live on to notice when it has passed
            if self._readable:
                log.exception("the API keys cannot be read; those known go on for %.0f s", self._patience)
            self._readable = False
        else:
            if not self._readable:
                log.info("the API keys can be read again")
            self._readable = True

    @contextlib.contextmanager
    def watching(self, every: float = LOOK_EVERY) -> Iterator[None]:
        """Look again and again beside the block, in a thread: a locked database holds up no request."""
        stop = threading.Event()

        def watch() -> None:
            while not stop.wait(every):
                self.look_again()

        thread = threading.Thread(target=watch, name="keys")
        thread.start()
        try:
            yield
        finally:
            stop.set()
            thread.join()

    def _looked(self, *, demanded: bool) -> _Look:
        at = time.monotonic()  # before it is read: what changes meanwhile counts as unseen
        keys = {key.id: key for key in self._active()}
        return _Look(keys=keys, demanded=demanded or bool(keys), at=at)


def _holder(key: ActiveKey) -> Holder:
    return Holder(identity=key.id, scope=key.scope, name=key.name)
