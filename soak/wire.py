"""HTTP by hand: bytes on a socket, so that a client may do what no library lets it."""

import contextlib
import json
import socket
import struct
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

PATIENCE = 120.0  # seconds for an answer; a service that hangs is found out after them
PIECE = 65536  # bytes read at once
RESET = struct.pack("ii", 1, 0)  # SO_LINGER: close at once, and tell the other side by a reset


@dataclass(frozen=True, kw_only=True)
class Address:
    """Where a service listens."""

    host: str
    port: int


@dataclass(frozen=True, kw_only=True)
class Reply:
    """An answer as it came."""

    status: int | None  # None: the connection ended without one
    headers: Mapping[str, str]  # names in lower case
    body: bytes

    @property
    def code(self) -> str | None:
        """The code of a problem; None for any other answer."""
        if self.headers.get("content-type") != "application/problem+json":
            return None
        return str(self.json()["code"])

    def json(self) -> Any:
        """Return what the body says."""
        return json.loads(self.body)


@contextlib.contextmanager
def connected(address: Address, patience: float = PATIENCE) -> Iterator[socket.socket]:
    """Lend a connection."""
    with socket.create_connection((address.host, address.port), timeout=patience) as connection:
        yield connection


def exchange(address: Address, sent: bytes, *, end: bool = False) -> Reply:
    """Send bytes and return the first answer.

    Parameters
    ----------
    sent : bytes
        Sent as they are; a service that answers before it has read them all may stop taking them.
    end : bool
        Say that nothing more will come.
    """
    with connected(address) as connection:
        with contextlib.suppress(BrokenPipeError, ConnectionResetError):
            connection.sendall(sent)
            if end:
                connection.shutdown(socket.SHUT_WR)
        return read_reply(connection, bodiless=sent.startswith(b"HEAD "))


def reset(connection: socket.socket) -> None:
    """Cut a connection as a crash or a pulled cable does."""
    connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, RESET)
    connection.close()


def read_reply(connection: socket.socket, *, bodiless: bool = False) -> Reply:
    """Read one answer, past any `100 Continue`; TimeoutError where the service hangs."""
    data = b""
    with contextlib.suppress(ConnectionResetError):
        while not _whole(data, bodiless) and (piece := connection.recv(PIECE)):
            data = _final(data + piece)
    return _reply(data)


def _final(data: bytes) -> bytes:
    return data.partition(b"\r\n\r\n")[2] if data.startswith(b"HTTP/1.1 100 ") else data


def _whole(data: bytes, bodiless: bool) -> bool:
    if b"\r\n\r\n" not in data:
        return False
    reply = _reply(data)
    return bodiless or len(reply.body) == int(reply.headers.get("content-length", "0"))


def _reply(data: bytes) -> Reply:
    head, _, body = data.partition(b"\r\n\r\n")
    first, *lines = head.decode("latin-1").split("\r\n")
    headers = {name.lower(): value.strip() for name, _, value in (line.partition(":") for line in lines)}
    status = int(first.split()[1]) if first.startswith("HTTP/") else None
    length = int(headers.get("content-length", len(body)))  # what follows is the next answer
    return Reply(status=status, headers=headers, body=body[:length])
