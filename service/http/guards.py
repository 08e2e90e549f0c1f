"""Who may call, and for what: API keys and their scopes, and no pages of other sites."""

from urllib.parse import SplitResult, urlsplit

from fastapi import Request
from fastapi.security import HTTPAuthorizationCredentials, HTTPBearer

from index.scopes import Scope
from service.http.upload_rate import UploadRate
from service.key_ring import Holder, KeyRing
from service.settings import is_loopback

SAFE_METHODS = frozenset({"GET", "HEAD", "OPTIONS"})
UPLOADS = frozenset({("POST", "/v1/shapes"), ("POST", "/v1/search")})  # counted by key
READING = frozenset({("POST", "/v1/search")})  # keeps nothing, whatever its method says

bearer = HTTPBearer(
    auto_error=False,
    description="An API key, from `faience key create` or FAIENCE_API_KEYS; needed as soon as there is one. "
    "A `read` key allows whatever changes nothing, a `write` key everything.",
)


class ReadOnlyKey(Exception):
    """A key that may read was sent with a request that changes something."""

    code = "read_only_key"
    headers = {"WWW-Authenticate": 'Bearer error="insufficient_scope"'}  # noqa: RUF012 - never changed


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
    host = request.headers.get("host", "")
    if not is_loopback(_split(f"//{host}").hostname or ""):
        raise ForeignHost(
            f"without keys the service answers to 127.0.0.1 and localhost only, not to {host[:100]!r}; "
            "make a key with `faience key create`, or start the service with --insecure"
        )


def check_key(
    request: Request, credentials: HTTPAuthorizationCredentials | None, keys: KeyRing
) -> Holder | None:
    """Return who sent a request, None where that does not matter.

    Raises
    ------
    Unauthorised, KeysUnreadable
        See `KeyRing.holder_of`.
    ReadOnlyKey
    """
    # headers arrive as Latin-1, whatever signs the key's bytes stand for
    holder = keys.holder_of(credentials.credentials.encode("latin-1") if credentials else None)
    if holder is not None and holder.scope is Scope.READ and _changes(request):
        raise ReadOnlyKey(
            f"this key may look and search, not {request.method} {request.url.path}; "
            "use a key of scope write (`faience key create NAME --scope write`)"
        )
    return holder


def check_rate(request: Request, holder: Holder | None, uploads: UploadRate) -> None:
    """Count an upload for the key that it came with, before anything of its body is read.

    Raises
    ------
    TooManyUploads
    """
    if holder is not None and _call(request) in UPLOADS:
        uploads.count(holder.identity)


def check_origin(request: Request) -> None:
    """Refuse a change that a browser sends for another site's page.

    Raises
    ------
    CrossOrigin
    """
    origin = request.headers.get("origin")
    if request.method in SAFE_METHODS or origin is None:
        return
    if _split(origin).netloc != request.headers.get("host"):
        raise CrossOrigin(f"a page of {origin[:100]} may not change this library")


def _split(address: str) -> SplitResult:
    """Take an address apart; what is none has no parts, so that no guard lets it pass."""
    try:
        return urlsplit(address)
    except ValueError:
        return urlsplit("")


def _changes(request: Request) -> bool:
    """Whether a request may change something; a call that nobody thought of here may."""
    return request.method not in SAFE_METHODS and _call(request) not in READING


def _call(request: Request) -> tuple[str, str]:
    return request.method, request.scope["path"]
