"""Services as processes of their own, and the processes below them, so that any can be killed."""

import contextlib
import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

import httpx

ROOT = Path(__file__).parents[1]
PATIENCE = 300.0  # seconds until what hangs counts as broken; the first start on a machine compiles for one


def wait_until(condition: Callable[[], bool], what: str = "what was waited for") -> None:
    """Wait; TimeoutError after a generous time."""
    deadline = time.monotonic() + PATIENCE
    while not condition():
        if time.monotonic() > deadline:
            raise TimeoutError(f"{what} did not happen within {PATIENCE:g} s")
        time.sleep(0.02)


def free_port() -> int:
    """Return a port that nobody uses now."""
    with contextlib.closing(socket.socket()) as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def descendants(pid: int) -> list[int]:
    """Return the living processes below one, on Linux: each thread tells its own children."""
    found: list[int] = []
    for listed in Path(f"/proc/{pid}/task").glob("*/children"):
        with contextlib.suppress(OSError):  # the thread or the process ended just now
            for child in listed.read_text().split():
                found += [int(child), *descendants(int(child))]
    return found


def alive(pid: int) -> bool:
    """Return whether a process is there and more than a name in the table."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] not in "ZX"
    except (FileNotFoundError, ProcessLookupError):
        return False


def kill(pid: int) -> bool:
    """Kill at once; return whether there was anything to kill."""
    try:
        os.kill(pid, signal.SIGKILL)
    except ProcessLookupError:
        return False
    return True


@dataclass
class Command:
    """One `faience` command that runs until it is ended, and can be started again."""

    arguments: tuple[str, ...]
    environment: dict[str, str] = field(default_factory=dict)  # beside this process's own
    process: subprocess.Popen[bytes] | None = None
    log: Path = Path(os.devnull)  # what it prints

    def start(self) -> None:
        """Start it, again where it was ended."""
        with self.log.open("ab") as log:
            self.process = subprocess.Popen(
                [sys.executable, "-c", "from service.commands.main import main; main()", *self.arguments],
                env={**os.environ, "PYTHONPATH": str(ROOT), **self.environment},
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=log,
            )

    @property
    def pid(self) -> int:
        """Return its number; it must have been started."""
        assert self.process is not None
        return self.process.pid

    def running(self) -> bool:
        """Return whether it has not ended."""
        return self.process is not None and self.process.poll() is None

    def family(self) -> list[int]:
        """Return the processes below it."""
        return descendants(self.pid) if self.running() else []

    def kill(self) -> None:
        """Kill it, and wait until all that it started has noticed."""
        family = self.family()
        if self.process is not None:
            self.process.kill()
            self.process.wait()
        wait_until(lambda: not any(map(alive, family)), "the end of a killed service's children")

    def stop(self) -> None:
        """Ask it to end; kill it where it does not."""
        if self.process is not None and self.running():
            self.process.terminate()
            try:
                self.process.wait(PATIENCE)
            finally:
                self.kill()


def serve(folder: Path, port: int, workers: int, environment: dict[str, str]) -> Command:
    """Return the API of a library, with a worker inside where ``workers`` is above 0."""
    arguments = ("serve", "--port", str(port), "--workers", str(workers), "--data-dir", str(folder))
    return Command(arguments, environment, log=folder.parent / "serve.log")


def work(folder: Path, environment: dict[str, str]) -> Command:
    """Return a worker of its own for a library."""
    arguments = ("worker", "--workers", "1", "--data-dir", str(folder))
    return Command(arguments, environment, log=folder.parent / "worker.log")


def answers(port: int) -> bool:
    """Return whether the service is ready."""
    try:
        return httpx.get(f"http://127.0.0.1:{port}/readyz", timeout=5).status_code == httpx.codes.OK
    except httpx.TransportError:
        return False


def start(service: Command, port: int) -> None:
    """Start a service where it does not run, and wait until it is ready."""
    if not service.running():
        service.start()
    wait_until(lambda: answers(port) or not service.running(), "the start of the service")
    if not service.running():
        raise RuntimeError(f"the service ended at its start, see {service.log}")


@contextlib.contextmanager
def ending(*commands: Command) -> Iterator[None]:
    """End what still runs when the block ends, whatever happened."""
    try:
        yield
    finally:
        for command in commands:
            command.kill()
