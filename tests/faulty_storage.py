"""An S3 server that fails on demand: a door before the real one, which passes on, refuses or hangs up."""

import http.client
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from urllib.parse import urlsplit

Fault = Callable[[str, str], int | None]  # method and path → status to answer, 0 to hang up, None to pass on
DROPPED = {"connection", "transfer-encoding", "content-length", "server", "date"}


class Door(ThreadingHTTPServer):
    """Passes requests on to a server, or not."""

    daemon_threads = True

    def __init__(self, server: str) -> None:
        super().__init__(("127.0.0.1", 0), _Handler)
        self.server = urlsplit(server).netloc
        self.address = f"http://127.0.0.1:{self.server_port}"
        self.asked: list[tuple[str, str]] = []  # methods and paths, in order
        self.told: dict[str, str] = {}  # headers of the last, names in lower case
        self.fault: Fault = lambda _method, _path: None

    def close(self) -> None:
        """Refuse everything from now on."""
        self.fault = lambda _method, _path: 500

    def open(self) -> None:
        """Pass everything on from now on."""
        self.fault = lambda _method, _path: None

    def handle_error(self, request: object, client_address: object) -> None:
        """Say nothing of clients that went away."""


class _Handler(BaseHTTPRequestHandler):
    server: Door
    protocol_version = "HTTP/1.1"

    def handle_any(self) -> None:
        body = self.rfile.read(int(self.headers.get("Content-Length", 0)))
        self.server.asked.append((self.command, self.path))
        self.server.told = {name.lower(): value for name, value in self.headers.items()}
        status = self.server.fault(self.command, self.path)
        if status is None:
            self._pass_on(body)
        elif status == 0:
            self.close_connection = True
            self.connection.close()
        else:
            self._answer(status, [], b"<Error><Code>InternalError</Code></Error>")

    do_GET = do_PUT = do_POST = do_DELETE = do_HEAD = handle_any  # noqa: N815 - as the library names them

    def _pass_on(self, body: bytes) -> None:
        onward = http.client.HTTPConnection(self.server.server)
        try:
            onward.request(self.command, self.path, body, dict(self.headers))
            answer = onward.getresponse()
            content = answer.read()
        finally:
            onward.close()
        size = answer.headers.get("Content-Length", str(len(content)))
        kept = [pair for pair in answer.getheaders() if pair[0].lower() not in DROPPED]
        self._answer(answer.status, kept, content, size)

    def _answer(
        self, status: int, headers: list[tuple[str, str]], content: bytes, size: str | None = None
    ) -> None:
        self.send_response(status)
        for name, value in headers:
            self.send_header(name, value)
        self.send_header("Content-Length", size or str(len(content)))
        self.end_headers()
        self.wfile.write(content)

    def log_message(self, format: str, *args: object) -> None:  # noqa: A002 - as the library names it
        """Say nothing."""


@contextmanager
def door(server: str) -> Iterator[Door]:
    """Run a door before a server."""
    made = Door(server)
    thread = threading.Thread(target=made.serve_forever)
    thread.start()
    try:
        yield made
    finally:
        made.shutdown()
        thread.join()
        made.server_close()
