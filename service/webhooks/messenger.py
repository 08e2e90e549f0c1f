"""Messenger: tells webhooks what happened, from every process that serves or works."""

import logging
import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import httpx2
from sqlalchemy import Engine

from index.deliveries import Deliveries, Delivery
from index.shapes import Shape
from service.webhooks.sending import PATIENCE, message, send

log = logging.getLogger(__name__)

Read = Callable[[str], Shape | None]
Render = Callable[[Shape], Mapping[str, Any]]

LEASE = 3 * PATIENCE  # seconds after which another process sends what this one took
LOOK_EVERY = 1.0  # seconds


class Messenger:
    """Sends what is due, one message after the other.

    Parameters
    ----------
    engine : Engine
        The catalogue's.
    read : callable
        Returns a shape by its id as it is now; None where it is gone.
    render : callable
        Returns a shape as the interface tells it.
    """

    def __init__(self, engine: Engine, read: Read, render: Render) -> None:
        self._deliveries, self._read, self._render = Deliveries(engine), read, render
        self._stopping = threading.Event()

    def run(self) -> None:
        """Work until `stop`; a message whose answer was not seen is sent again."""
        with httpx2.Client(follow_redirects=False) as client:
            while not self._stopping.is_set():
                try:
                    if self.send_one(client):
                        continue
                except Exception:  # a database that is away for a while must not end the messenger
                    log.exception("the messenger goes on after an error")
                self._stopping.wait(LOOK_EVERY)

    def send_one(self, client: httpx2.Client) -> bool:
        """Send the oldest message that is due; return whether there was one."""
        delivery = self._deliveries.claim(LEASE)
        if delivery is None:
            return False
        shape = self._read(delivery.shape_id)
        if shape is None or shape.status != delivery.status:  # gone, or queued again: another one will follow
            self._deliveries.drop(delivery)
            return True
        failure = self._send(client, delivery, shape)
        if failure is None:
            self._deliveries.told(delivery)
        else:
            log.warning("%s was not told of shape %s: %s", delivery.url, shape.id, failure)
            self._deliveries.failed(delivery, failure)
        return True

    def stop(self) -> None:
        """Ask `run` to end."""
        self._stopping.set()

    def _send(self, client: httpx2.Client, delivery: Delivery, shape: Shape) -> str | None:
        body = message(f"shape.{delivery.status}", delivery.happened_at, self._render(shape))
        return send(client, delivery.url, delivery.secret, f"msg_{delivery.id}", body)


@contextmanager
def telling(engine: Engine, read: Read, render: Render) -> Iterator[None]:
    """Run a messenger beside what is done here."""
    messenger = Messenger(engine, read, render)
    thread = threading.Thread(target=messenger.run, name="messenger")
    thread.start()
    try:
        yield
    finally:
        messenger.stop()
        thread.join()
