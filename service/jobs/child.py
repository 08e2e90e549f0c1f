"""The inside of a child process: take the limits, run one function, send what came of it."""

import multiprocessing
import os
import resource
import signal
import threading
import traceback
from collections.abc import Callable
from dataclasses import dataclass
from multiprocessing.connection import Connection
from typing import Any

from index.errors import StorageUnreachable
from worker.errors import Code, MeshError


@dataclass(frozen=True, kw_only=True)
class ChildLimits:
    """What one job may use."""

    memory_bytes: int  # address space of the child
    cpu_seconds: int  # processor time
    wall_seconds: float  # time by the clock, kept by the parent


class ChildError(Exception):
    """The function raised what it never should; the text is the child's traceback, for the log only."""


def answer(sender: Connection, limits: ChildLimits, function: Callable[..., Any], *args: Any) -> None:
    """Run ``function(*args)`` within the limits and send its value or its exception.

    Parameters
    ----------
    sender : Connection
        Where the outcome goes; closed at the end.
    limits : ChildLimits
        Over ``cpu_seconds`` the kernel ends the process; over ``memory_bytes`` allocations fail.
    function : callable
        Importable by name, as everything that crosses into another process.
    """
    _prepare(limits)
    sender.send(_outcome(limits, function, args))
    sender.close()


def _prepare(limits: ChildLimits) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is the parent's to handle
    threading.Thread(target=_end_with_parent, daemon=True).start()
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_CPU, (limits.cpu_seconds, limits.cpu_seconds + 1))
    _limit_memory(limits.memory_bytes)


def _outcome(limits: ChildLimits, function: Callable[..., Any], args: tuple[Any, ...]) -> Any:
    try:
        return function(*args)
    except MemoryError:
        _limit_memory(resource.RLIM_INFINITY)  # room to say so
        limit = limits.memory_bytes // 2**20
        return MeshError(Code.TOO_COMPLEX, f"needs more than the {limit} MiB of memory that one job may use")
    except (MeshError, StorageUnreachable) as error:
        return error
    except Exception:  # noqa: BLE001 - a defect in one computation must not look like a dead process
        return ChildError(traceback.format_exc())


def _limit_memory(limit: int) -> None:
    _, hard = resource.getrlimit(resource.RLIMIT_AS)
    if hard != resource.RLIM_INFINITY:
        limit = hard if limit == resource.RLIM_INFINITY else min(limit, hard)
    resource.setrlimit(resource.RLIMIT_AS, (limit, hard))


def _end_with_parent() -> None:
    """End this process when the service that asked is gone, however it went."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)
