"""Workers in threads, for tests that hand them meshes and look what becomes of them."""

import threading
from collections.abc import Callable
from concurrent.futures import Executor, Future
from typing import Any

from index.shapes import Shape, Status
from service.intake.submissions import receive_paths
from service.jobs.workers import Worker
from service.library import Library
from service.retrieval import accept_upload
from tests.fakes import coloured_triangle, describe_quickly
from tests.serving import wait_until


class SameThread(Executor):
    """Runs a job at once, without a process."""

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Run it."""
        future: Future[Any] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:  # noqa: BLE001 - this is what executors do
            future.set_exception(error)
        return future


class Working:
    """A worker in a thread."""

    def __init__(self, library: Library, executor: Executor, **options: Any) -> None:
        self.outcomes: list[str] = []
        self.finish_seconds = 0.0
        self.worker = Worker(
            library,
            executor,
            **{
                "slots": 2,
                "describe": describe_quickly,
                "observe": lambda outcome, _: self.outcomes.append(outcome),
                **options,
            },
        )
        self.thread = threading.Thread(target=self.worker.run)

    def __enter__(self) -> "Working":
        """Start it."""
        self.thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        """Stop it; it must end by itself."""
        self.worker.stop(self.finish_seconds)
        self.thread.join()


def accept(library: Library, name: str, content: bytes | None = None) -> str:
    path = library.incoming.folder / name
    path.write_bytes(content or coloured_triangle())
    shape, _ = accept_upload(library, receive_paths({name: path}))
    path.unlink()
    return shape.id


def settled(library: Library, shape_id: str) -> Shape:
    wait_until(lambda: library.catalogue.get(shape_id).status in (Status.READY, Status.FAILED))
    return library.catalogue.get(shape_id)
