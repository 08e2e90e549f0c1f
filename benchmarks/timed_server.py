"""The service in a process of its own, which tells how long its processor worked, and on what."""

import threading
import time
from collections.abc import Callable, Mapping
from multiprocessing.connection import Connection
from multiprocessing.context import SpawnContext
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import uvicorn

from index.searcher import Searcher
from service import refining
from service.app import create_app
from service.settings import Settings

PATIENCE = 120.0  # seconds for its start
PARTS = {"index": (Searcher, "search"), "registration": (refining, "additions_to")}

Times = Mapping[str, float]  # processor seconds so far: of "all", and of the PARTS


class TimedServer:
    """Runs while it is entered.

    Parameters
    ----------
    folder : Path
        Of the library.
    context : SpawnContext
        Makes the process.
    """

    def __init__(self, folder: Path, context: SpawnContext) -> None:
        self._pipe, other = context.Pipe()
        self._process = context.Process(target=_serve, args=(folder, other))
        self.port = 0

    def __enter__(self) -> Self:
        self._process.start()
        if not self._pipe.poll(PATIENCE):
            raise TimeoutError("the server did not start")
        self.port = self._pipe.recv()
        return self

    def __exit__(self, *_: type[BaseException] | BaseException | TracebackType | None) -> None:
        self._pipe.send("stop")
        self._process.join()

    def times(self) -> Times:
        """Return what the server has spent."""
        self._pipe.send("times")
        told: Times = self._pipe.recv()
        return told


def _serve(folder: Path, pipe: Connection) -> None:
    spent = {part: _timed(*place) for part, place in PARTS.items()}
    app = create_app(Settings(data_dir=folder, port=0, workers=0))
    server = uvicorn.Server(uvicorn.Config(app, port=0, log_config=None, access_log=False))
    threading.Thread(target=_tell, args=(server, pipe, spent), daemon=True).start()
    server.run()


def _timed(holder: Any, name: str) -> list[float]:
    """Put a stopwatch around a function; return its times so far, of which none gets lost between threads."""
    inner: Callable[..., Any] = getattr(holder, name)
    spent: list[float] = []

    def timed(*arguments: Any, **named: Any) -> Any:
        start = time.thread_time()
        try:
            return inner(*arguments, **named)
        finally:
            spent.append(time.thread_time() - start)

    setattr(holder, name, timed)
    return spent


def _tell(server: uvicorn.Server, pipe: Connection, spent: Mapping[str, list[float]]) -> None:
    while not server.started:
        time.sleep(0.05)
    pipe.send(server.servers[0].sockets[0].getsockname()[1])
    while pipe.recv() == "times":
        pipe.send({"all": time.process_time()} | {part: sum(times) for part, times in spent.items()})
    server.should_exit = True
