"""A Dask cluster in tests: a scheduler and machines that compute, as processes on this machine."""

import contextlib
import os
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from service.jobs.cluster import Cluster
from soak.processes import ROOT, Command, ending, free_port
from tests.fakes import describe_quickly
from tests.serving import wait_until
from worker.describe import Description


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


def describe_at_a_gate(
    folder: Path, files: Mapping[str, Any], allow_untextured: bool, parameters: Any, limits: Any
) -> Description:
    """Leave a mark in a folder for each attempt; describe when the gate is open."""
    (folder / f"{next(iter(files))}-{os.getpid()}").touch()
    while not (folder / "open").exists():
        time.sleep(0.02)
    return describe_quickly(files, allow_untextured, parameters, limits)
