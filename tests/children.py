"""Functions for child processes in tests: importable by name, each with its own way to go."""

import os
import signal
import time
from pathlib import Path

import numpy as np
from threadpoolctl import threadpool_info

from worker.errors import Code, MeshError


def add(left: int, right: int) -> int:
    return left + right


def identify() -> int:
    return os.getpid()


def threads_of_numpy() -> set[int]:
    return {library["num_threads"] for library in threadpool_info()}


def exit_at_once(code: int) -> None:
    os._exit(code)


def kill_itself() -> None:
    os.kill(os.getpid(), signal.SIGKILL)


def hang() -> None:
    time.sleep(3600)


def spin() -> None:
    while True:
        pass


def eat_memory() -> int:
    kept = [np.ones(2**24) for _ in range(2**12)]  # 128 MiB each
    return len(kept)


def refuse() -> None:
    raise MeshError(Code.NO_FACES, "points only")


def have_a_defect() -> None:
    raise KeyError("a defect")


def return_much(size: int) -> bytes:
    return bytes(size)


def exit_unless(mark: Path) -> str:
    """Die the first time, answer the second."""
    if mark.exists():
        return "second"
    mark.touch()
    os._exit(3)


def write_identity_and_hang(path: Path) -> None:
    aside = path.with_suffix(".part")
    aside.write_text(str(os.getpid()))
    aside.rename(path)
    time.sleep(3600)
