"""Signatures of messages, after the Standard Webhooks specification 1.0 (2023), "Signature scheme"."""

import base64
import hashlib
import hmac

PREFIX = "whsec_"  # of a secret as people copy it


def shown(secret: bytes) -> str:
    """Return a secret as receivers' libraries take it."""
    return PREFIX + base64.b64encode(secret).decode()


def signature(secret: bytes, message_id: str, timestamp: int, body: bytes) -> str:
    """Return the value of the header ``webhook-signature``.

    Parameters
    ----------
    timestamp : int
        Seconds since 1970, as in ``webhook-timestamp``: an old message that is sent again is known by it.
    """
    signed = b".".join((message_id.encode(), str(timestamp).encode(), body))
    return "v1," + base64.b64encode(hmac.digest(secret, signed, hashlib.sha256)).decode()
