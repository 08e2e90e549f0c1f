"""An executor that gives every job a process of its own, so that one job can only harm itself.

A process comes from a preloaded fork server (about ten milliseconds), runs one function and ends. It is
killed at its wall limit; memory and processor time are limited by the kernel (see `service.jobs.child`).
"""

import contextlib
import multiprocessing
import multiprocessing.forkserver
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from multiprocessing.connection import Connection
from multiprocessing.context import ForkServerProcess
from typing import Any, TypeVar

from service.jobs.child import ChildLimits, answer
from worker.errors import Code, MeshError

Value = TypeVar("Value")


class ChildDied(Exception):
    """The process ended without an answer: it crashed, or somebody killed it."""

    def __init__(self, exit_code: int | None) -> None:
        super().__init__(f"the process ended without an answer (exit code {exit_code})")
        self.exit_code = exit_code

    def __reduce__(self) -> tuple[type["ChildDied"], tuple[int | None]]:
        """Cross process borders with the exit code, not with the message made of it."""
        return type(self), (self.exit_code,)


class PoolStopped(Exception):
    """The pool was shut down before the job ended; the job itself is not to blame."""


class ProcessPerJob(Executor):
    """Runs each submitted function in a fresh process, at most ``slots`` at a time.

    A future of this pool raises `worker.errors.MeshError` (``too_complex``) for a job over its limits,
    `ChildDied` for a process that ended on its own, `service.jobs.child.ChildError` for a defect in the
    function, `PoolStopped` when the pool was shut down.

    Parameters
    ----------
    slots : int
        Jobs at the same time.
    limits : ChildLimits
        What each may use.
    preload : sequence of str
        Modules that children find imported, beside those of `service.jobs.preload`.
    """

    def __init__(self, *, slots: int, limits: ChildLimits, preload: Sequence[str] = ()) -> None:
        self._context = multiprocessing.get_context("forkserver")
        self._context.set_forkserver_preload(["service.jobs.preload", *preload])
        self._limits = limits
        self._threads = ThreadPoolExecutor(max_workers=slots, thread_name_prefix="job")
        self._children: set[ForkServerProcess] = set()
        self._lock = threading.Lock()
        self._stopped = False

    def warm(self) -> None:
        """Start the fork server now, so that the first job does not wait for its imports."""
        multiprocessing.forkserver.ensure_running()

    def submit(self, fn: Callable[..., Value], /, *args: Any, **kwargs: Any) -> Future[Value]:
        """Start ``fn(*args)`` in a process of its own as soon as a slot is free."""
        if kwargs:
            raise TypeError("arguments by name do not cross the process border here")
        return self._threads.submit(self._run, fn, args)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Take no more jobs; with ``cancel_futures`` also kill those that run."""
        if cancel_futures:
            with self._lock:
                self._stopped = True
                for child in self._children:
                    child.kill()
        self._threads.shutdown(wait=wait, cancel_futures=cancel_futures)

    def _run(self, function: Callable[..., Value], args: tuple[Any, ...]) -> Value:
        receiver, sender = self._context.Pipe(duplex=False)
        with receiver:
            with sender:  # the parent's copy must be closed, or the child's death would not be an end of file
                child = self._start(sender, function, args)
            try:
                outcome = self._receive(child, receiver)
            finally:
                self._end(child)
        if isinstance(outcome, Exception):
            raise outcome
        return outcome  # type: ignore[no-any-return]  # the child's word for it

    def _start(
        self, sender: Connection, function: Callable[..., Any], args: tuple[Any, ...]
    ) -> ForkServerProcess:
        child = self._context.Process(
            target=answer, args=(sender, self._limits, function, *args), daemon=True
        )
        with self._lock, _without_main():
            if self._stopped:
                raise PoolStopped
            try:
                child.start()
            except (EOFError, OSError) as error:  # the fork server died; the next start makes a new one
                raise ChildDied(None) from error
            self._children.add(child)
        return child

    def _receive(self, child: ForkServerProcess, receiver: Connection) -> Any:
        overdue = threading.Event()
        timer = threading.Timer(self._limits.wall_seconds, _kill, (child, overdue))
        timer.daemon = True
        timer.start()
        try:
            return receiver.recv()
        except (EOFError, OSError):
            child.join()
            return self._death(child, overdue=overdue.is_set())
        finally:
            timer.cancel()

    def _death(self, child: ForkServerProcess, *, overdue: bool) -> Exception:
        if self._stopped:
            return PoolStopped()
        if overdue:
            limit = f"{self._limits.wall_seconds:g} s"
            return MeshError(Code.TOO_COMPLEX, f"needs more than the {limit} that one job may take")
        if child.exitcode == -signal.SIGXCPU:
            limit = f"{self._limits.cpu_seconds} s"
            return MeshError(Code.TOO_COMPLEX, f"needs more than the {limit} of processor time of one job")
        return ChildDied(child.exitcode)

    def _end(self, child: ForkServerProcess) -> None:
        with self._lock:
            self._children.discard(child)
        child.kill()  # it has answered or is dead; what lingers in an exit handler is not waited for
        child.join()
        child.close()


def _kill(child: ForkServerProcess, overdue: threading.Event) -> None:
    overdue.set()
    with contextlib.suppress(ValueError):  # it ended and was closed in this very moment
        child.kill()


@contextlib.contextmanager
def _without_main() -> Iterator[None]:
    """Hide where the command's own script is, or every child would import all of it again."""
    main = sys.modules["__main__"]
    saved = {name: getattr(main, name) for name in ("__file__", "__spec__") if hasattr(main, name)}
    try:
        for name in saved:
            setattr(main, name, None)
        yield
    finally:
        for name, value in saved.items():
            setattr(main, name, value)
