"""A real server in a thread, so that tests speak HTTP over sockets."""

import contextlib
import functools
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import uvicorn

from index.vocabulary import Vocabulary, learn_vocabulary
from service.app import create_app
from service.draining import DrainingServer
from service.http.connections import BoundedConnection
from service.http.dependencies import Services
from service.jobs.describing import Describe
from service.library import Library
from service.settings import Settings
from soak.wire import Address
from tests.databases import DATABASES
from tests.fakes import describe_quickly, fake_signatures
from tests.storages import PLACES
from worker.parameters import Parameters

PATIENCE = 120.0  # seconds until a test that would hang fails instead


def settings_for(folder: Path, **changes: Any) -> Settings:
    """Return settings for a test: small limits, a quick worker."""
    quick: dict[str, Any] = {
        "data_dir": folder,
        "port": 0,
        "poll_seconds": 0.05,
        "job_memory_bytes": 2 * 2**30,
        "reserve_bytes": 2**20,
        "workers": 2,
    }
    if DATABASES.kind == "postgresql":
        folder.mkdir(parents=True, exist_ok=True)
        quick["database_url"] = DATABASES.url(folder)
    quick["storage_url"] = PLACES.url(folder)
    return Settings(**{**quick, **changes})


@functools.cache
def fake_vocabulary(seed: int = 0) -> Vocabulary:
    samples = [fake_signatures(level) for level in np.linspace(0, 1, 7)]
    return learn_vocabulary(samples, Parameters().fingerprint(), seed=seed)


def open_fake_library(settings: Settings) -> Library:
    return Library.open(settings, vocabulary=fake_vocabulary())


class Serving:
    """A running service and a client of it."""

    def __init__(self, services: Services, client: httpx.Client, server: DrainingServer) -> None:
        self.services, self.client, self.server = services, client, server
        self.library, self.turnstile = services.library, services.turnstile

    @property
    def address(self) -> Address:
        """Where it listens."""
        return Address(host=self.client.base_url.host, port=self.client.base_url.port or 80)

    def add(self, files: dict[str, bytes], wait: float = 60, **fields: str) -> httpx.Response:
        """Upload files."""
        parts = [("files", (name, content)) for name, content in files.items()]
        return self.client.post("/v1/shapes", params={"wait": wait}, files=parts, data=fields)

    def shape(self, shape_id: str) -> dict[str, Any]:
        """Return a shape's JSON."""
        found: dict[str, Any] = self.client.get(f"/v1/shapes/{shape_id}").json()
        return found

    def settled(self, shape_id: str) -> dict[str, Any]:
        """Return a shape when it is ready or failed."""
        wait_until(lambda: self.shape(shape_id)["status"] in ("ready", "failed"))
        return self.shape(shape_id)


def wait_until(condition: Callable[[], bool]) -> None:
    """Wait; fail after a generous time."""
    deadline = time.monotonic() + PATIENCE
    while not condition():
        if time.monotonic() > deadline:
            raise TimeoutError("what was waited for did not happen")
        time.sleep(0.02)


@contextlib.contextmanager
def serving(
    settings: Settings,
    describe: Describe = describe_quickly,
    open_library: Callable[[Settings], Library] = open_fake_library,
    connection: type[BoundedConnection] = BoundedConnection,
    drain_seconds: float = 0,
) -> Iterator[Serving]:
    """Run the service; stop it cleanly at the end."""
    app = create_app(settings, open_library=open_library, describe=describe)
    config = uvicorn.Config(app, http=connection, port=0, log_config=None, timeout_graceful_shutdown=5)
    server = DrainingServer(config, drain_seconds, lambda: app.state.services)
    thread = threading.Thread(target=server.run)
    thread.start()
    try:
        wait_until(lambda: server.started or not thread.is_alive())
        wait_until(lambda: not any(each.name == "first load" for each in threading.enumerate()))
        port = server.servers[0].sockets[0].getsockname()[1]
        with httpx.Client(base_url=f"http://127.0.0.1:{port}", timeout=PATIENCE) as client:
            yield Serving(app.state.services, client, server)
    finally:
        server.should_exit = True
        thread.join()
