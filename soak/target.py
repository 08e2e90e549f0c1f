"""The service that clients of the soak are rude to, and what can be seen of it from outside."""

import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from soak.wire import Address, Reply, exchange

BOUNDARY = "a-boundary"


@dataclass(frozen=True, kw_only=True)
class Target:
    """A running service and its data folder."""

    address: Address
    folder: Path
    key: str | None = None  # that may write, where the service has keys

    def head(self, method: str, path: str, *headers: str) -> bytes:
        """Return the head of a request; the connection ends with its answer."""
        lines = [f"{method} {path} HTTP/1.1", f"Host: {self.address.host}", "Connection: close", *headers]
        lines += [f"Authorization: Bearer {self.key}"] if self.key else []
        return "\r\n".join([*lines, "", ""]).encode()

    def upload_head(self, *framing: str) -> bytes:
        """Return the head of an upload; ``framing`` says how long its body is."""
        form = f"Content-Type: multipart/form-data; boundary={BOUNDARY}"
        return self.head("POST", "/v1/shapes", form, *framing)

    def upload(self, body: bytes) -> Reply:
        """Send a form as it should be sent."""
        return exchange(self.address, self.upload_head(f"Content-Length: {len(body)}") + body)

    def ask(self, method: str, path: str) -> Reply:
        """Send a request without a body."""
        return exchange(self.address, self.head(method, path))

    def shapes(self) -> Iterator[dict[str, Any]]:
        """Yield every shape of the library."""
        cursor = ""
        while cursor is not None:
            page = self.ask("GET", f"/v1/shapes?limit=500{cursor and f'&cursor={cursor}'}").json()
            yield from page["items"]
            cursor = page["next_cursor"]

    def files(self) -> set[str]:
        """Return the files of uploads, finished or not, that lie in the data folder."""
        found: set[str] = set()
        for place in ("files/uploads", "files/.incoming", "incoming"):
            for parent, _, names in os.walk(self.folder / place):  # bears folders that go meanwhile
                found |= {os.path.join(parent, name) for name in names if name not in (".lock", ".sweep")}  # noqa: PTH118 - walk gives text
        return found


def form(files: Mapping[str, bytes]) -> bytes:
    """Return files as the body of a form."""
    parts = b"".join(
        f'--{BOUNDARY}\r\nContent-Disposition: form-data; name="files"; filename="{name}"\r\n\r\n'.encode()
        + content
        + b"\r\n"
        for name, content in files.items()
    )
    return parts + f"--{BOUNDARY}--\r\n".encode()
