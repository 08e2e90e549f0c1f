"""A job packed for another machine, which does not see the files of this one."""

import pickle
from collections.abc import Callable
from typing import Any

from service.jobs.describing import FilesOnDisk, KeptFiles


def packed(function: Callable[..., Any], args: tuple[Any, ...]) -> bytes:
    """Pickle a function and its arguments; files on this machine's disks go along whole.

    Raises
    ------
    OSError, FileMissing
        A file cannot be read: it is gone, perhaps with its shape.
    """
    return pickle.dumps((function, tuple(map(_carried, args))), protocol=pickle.HIGHEST_PROTOCOL)


def run_packed(payload: bytes) -> Any:
    """Call a packed function; this module imports little, since each child that runs one loads it."""
    function, args = pickle.loads(payload)  # noqa: S301 - the cluster's own clients are trusted
    return function(*args)


def _carried(argument: Any) -> Any:
    here = isinstance(argument, FilesOnDisk) or (isinstance(argument, KeptFiles) and argument.here)
    return dict(argument) if here else argument
