"""Whether the service may listen where it is told to: never open to other machines by accident."""

from index.keys import has_active_key
from service.settings import Settings, is_loopback


class UnsafeListening(Exception):
    """The service would be open to other machines without a key."""


def check_listening(settings: Settings) -> None:
    """Refuse to be open to other machines without a key; nothing is made meanwhile.

    Raises
    ------
    UnsafeListening
        With what to do about it.
    """
    if settings.insecure or settings.api_keys or is_loopback(settings.host) or has_active_key(settings.url):
        return
    raise UnsafeListening(
        f"refusing to listen on {settings.host!r} without a key: other machines could read and delete "
        "everything. Make a key with `faience key create NAME --scope write`, set FAIENCE_API_KEYS, or pass "
        "--insecure where the network itself is trusted."
    )
