"""Connection: requests that are tried again until the service answers."""

import random
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any, TypeVar

import httpx2

from faience_client.errors import NotReached, Refused

AGAIN = frozenset({429, 502, 503, 504})  # the service, or a proxy before it, cannot answer now
FIRST_WAIT, LONGEST_WAIT = 0.2, 10.0  # seconds between two tries, where the service asks for none
SILENCE = 60.0  # seconds without a byte after which a try is given up, beyond what a call waits itself

Parameters = Mapping[str, Any]
Model = TypeVar("Model")


class Connection:
    """One service.

    Parameters
    ----------
    address : str
        Such as ``http://127.0.0.1:8000``.
    key : str, optional
        Where the service asks for one.
    patience : float
        Seconds in which a call is tried again.
    """

    def __init__(self, address: str, key: str | None, patience: float) -> None:
        headers = {"Authorization": f"Bearer {key}"} if key else {}
        self._http = httpx2.Client(base_url=address, headers=headers, timeout=SILENCE)
        self._patience = patience

    def close(self) -> None:
        """Let go of the connections."""
        self._http.close()

    def ask(self, path: str, **parameters: Any) -> Any:
        """Return the JSON of a GET."""
        return self.send("GET", path, parameters).json()

    def send(
        self,
        method: str,
        path: str,
        parameters: Parameters | None = None,
        *,
        body: Callable[[], Mapping[str, Any]] = dict,
        waits: float = 0.0,
    ) -> httpx2.Response:
        """Send a request until it is answered.

        Parameters
        ----------
        body : callable
            Makes the body anew for each try: a file that was half sent must be read from its beginning.
        waits : float
            Seconds that the service may keep its answer.

        Raises
        ------
        Refused
            By the service.
        NotReached
            There was no answer within the client's patience.
        """
        deadline, wait, repeated = time.monotonic() + self._patience + waits, FIRST_WAIT, False
        while True:
            try:
                response = self._http.request(
                    method, path, params=_given(parameters), timeout=SILENCE + waits, **body()
                )
            except httpx2.TransportError as error:
                repeated, asked, failure = True, None, f"{type(error).__name__}: {error}"
            else:
                if response.status_code not in AGAIN:
                    return _accepted(response, repeated=repeated)
                asked, failure = response.headers.get("retry-after"), _words(response)
            pause = _pause(asked, wait)
            if time.monotonic() + pause > deadline:
                raise NotReached(f"{method} {path} was not answered: {failure}")
            time.sleep(pause)
            wait = min(2 * wait, LONGEST_WAIT)

    @contextmanager
    def stream(
        self, path: str, parameters: Parameters | None = None, headers: Mapping[str, str] | None = None
    ) -> Iterator[httpx2.Response]:
        """Open an answer that is read piece by piece; tried once.

        Raises
        ------
        Refused, httpx2.TransportError
        """
        with self._http.stream("GET", path, params=_given(parameters), headers=headers) as response:
            if response.is_error:
                response.read()
            yield _accepted(response)

    def pages(self, path: str, read: Callable[[Any], Model], **parameters: Any) -> Iterator[Model]:
        """Yield the items of a list, page after page, each when it is needed."""
        cursor = None
        while True:
            page = self.ask(path, **parameters, cursor=cursor)
            yield from map(read, page["items"])
            cursor = page["next_cursor"]
            if cursor is None:
                return


def _given(parameters: Parameters | None) -> dict[str, Any]:
    """Return the parameters that are not None, as the service writes them."""
    return {name: _text(value) for name, value in (parameters or {}).items() if value is not None}


def _text(value: Any) -> Any:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, Mapping):  # weights
        return ",".join(f"{name}:{number:g}" for name, number in value.items())
    return list(value) if isinstance(value, Sequence) and not isinstance(value, str) else value


def _accepted(response: httpx2.Response, *, repeated: bool = False) -> httpx2.Response:
    if response.is_success:
        return response
    refused = Refused.of(response.status_code, _body(response))
    refused.repeated = repeated
    raise refused


def _body(response: httpx2.Response) -> Any:
    try:
        return response.json()
    except ValueError:  # a proxy's page
        return response.text[:200]


def _words(response: httpx2.Response) -> str:
    return str(Refused.of(response.status_code, _body(response)))


def _pause(asked: str | None, wait: float) -> float:
    """Return seconds to the next try: as the service asks, or about so long."""
    if asked is not None and asked.isdecimal():
        return float(asked)
    return wait * random.uniform(0.5, 1.0)  # noqa: S311 - so that many clients do not come back together
