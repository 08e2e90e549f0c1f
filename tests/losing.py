"""A connection that loses answers: what was asked is carried out, and nobody is told."""

import contextlib
import socket
import threading
from collections.abc import Iterator

from soak.wire import Address

ENOUGH = 1 << 16  # bytes at once


class Losing:
    """Passes bytes on to a service, but cuts the connection in place of the first answers.

    Attributes
    ----------
    left : int
        Answers that are still lost.
    """

    def __init__(self, service: Address, lost: int) -> None:
        self._service, self.left = service, lost
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.url = f"http://127.0.0.1:{self._listener.getsockname()[1]}"

    def run(self) -> None:
        """Take connections until `stop`."""
        while True:
            try:
                client, _ = self._listener.accept()
            except OSError:
                return
            threading.Thread(target=self._pass_on, args=(client,), daemon=True).start()

    def stop(self) -> None:
        """Take no more."""
        self._listener.shutdown(socket.SHUT_RDWR)
        self._listener.close()

    def _pass_on(self, client: socket.socket) -> None:
        with client, socket.create_connection((self._service.host, self._service.port)) as service:
            asking = threading.Thread(target=_copy, args=(client, service), daemon=True)
            asking.start()
            with contextlib.suppress(OSError):
                while answer := service.recv(ENOUGH):
                    if self.left:
                        self.left -= 1
                        break
                    client.sendall(answer)
            for end in (client, service):
                with contextlib.suppress(OSError):
                    end.shutdown(socket.SHUT_RDWR)
            asking.join()


def _copy(one: socket.socket, other: socket.socket) -> None:
    with contextlib.suppress(OSError):
        while piece := one.recv(ENOUGH):
            other.sendall(piece)


@contextlib.contextmanager
def losing(service: Address, lost: int = 1) -> Iterator[Losing]:
    """Run such a connection."""
    between = Losing(service, lost)
    thread = threading.Thread(target=between.run)
    thread.start()
    try:
        yield between
    finally:
        between.stop()
        thread.join()
