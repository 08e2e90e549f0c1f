"""Who may call: API keys, and no pages of other sites."""

import hashlib
import hmac
from urllib.parse import urlsplit

from fastapi import Request
from fastapi.security import HTTPAuthorizationCredentials, HTTPBearer

from service.settings import is_loopback

SAFE_METHODS = frozenset({"GET", "HEAD", "OPTIONS"})

bearer = HTTPBearer(auto_error=False, description="An API key of FAIENCE_API_KEYS, where keys are set.")


class Unauthorised(Exception):
    """No key, or one that is not known."""

    code = "unauthorised"


class CrossOrigin(Exception):
    """A page of another site sent a request that changes something."""

    code = "cross_origin"


class ForeignHost(Exception):
    """A request by another name than this machine's own, to a service that is open to this machine alone."""

    code = "foreign_host"


def check_host(request: Request) -> None:
    """Refuse other names where no key protects the library: a page may point its own name at this machine.

    Raises
    ------
    ForeignHost
    """
    if not request.app.state.for_this_machine:
        return
    host = request.headers.get("host", "")
    if not is_loopback(urlsplit(f"//{host}").hostname or ""):
        raise ForeignHost(
            f"without keys the service answers to 127.0.0.1 and localhost only, not to {host[:100]!r}; "
            "set FAIENCE_API_KEYS, or start it with --insecure"
        )


def check_key(credentials: HTTPAuthorizationCredentials | None, digests: tuple[bytes, ...]) -> None:
    """Compare a request's key with every known one, in constant time.

    Raises
    ------
    Unauthorised
    """
    if not digests:
        return
    sent = hashlib.sha256(credentials.credentials.encode() if credentials else b"").digest()
    matches = [hmac.compare_digest(sent, digest) for digest in digests]
    if credentials is None or not any(matches):
        raise Unauthorised("send a known key in the header `Authorization: Bearer …`")


def check_origin(request: Request) -> None:
    """Refuse a change that a browser sends for another site's page.

    Raises
    ------
    CrossOrigin
    """
    origin = request.headers.get("origin")
    if request.method in SAFE_METHODS or origin is None:
        return
    if urlsplit(origin).netloc != request.headers.get("host"):
        raise CrossOrigin(f"a page of {origin[:100]} may not change this library")
