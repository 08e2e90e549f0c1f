"""A Dask cluster in tests: a scheduler and machines that compute, as processes on this machine."""

import contextlib
import os
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from service.jobs.cluster import Cluster
from soak.processes import ROOT, Command, ending, free_port
from tests.serving import wait_until


@dataclass
class Scheduler(Command):
    """What `dask scheduler` starts, for this machine alone."""

    def start(self) -> None:
        """Start it, again where it was ended."""
        options = ("--host", "127.0.0.1", "--dashboard-address", "127.0.0.1:0", "--no-show")
        with self.log.open("ab") as log:
            self.process = subprocess.Popen(
                [sys.executable, "-m", "dask", "scheduler", *options, *self.arguments],
                env={**os.environ, "PYTHONPATH": str(ROOT)},
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=log,
            )


@dataclass(frozen=True, kw_only=True)
class Machines:
    """A scheduler and those that compute for it."""

    address: str
    scheduler: Scheduler
    computers: tuple[Command, ...]


@contextlib.contextmanager
def machines(folder: Path, *threads: int) -> Iterator[Machines]:
    """Start a cluster; its machines compute as many jobs at the same time as said for each."""
    port = free_port()
    address = f"tcp://127.0.0.1:{port}"
    scheduler = Scheduler(("--port", str(port)), log=folder / "scheduler.log")
    computers = [
        Command(
            ("compute", "--cluster", address, "--workers", str(each)), log=folder / f"compute-{number}.log"
        )
        for number, each in enumerate(threads)
    ]
    with ending(*computers, scheduler):
        for command in (scheduler, *computers):
            command.start()
        yield Machines(address=address, scheduler=scheduler, computers=tuple(computers))


def takes(cluster: Cluster, slots: int) -> None:
    """Wait until the cluster takes as many jobs at the same time."""
    wait_until(lambda: cluster.slots() == slots)
