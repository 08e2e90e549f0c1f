"""A job packed for another machine, which does not see the files of this one."""

import pickle
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any


@dataclass(frozen=True, kw_only=True)
class Carried:
    """A file's content, for those who would read it from a path."""

    content: bytes

    def read_bytes(self) -> bytes:
        """Return the content, as a path does."""
        return self.content


def packed(function: Callable[..., Any], args: tuple[Any, ...]) -> bytes:
    """Pickle a function and its arguments; files on this machine's disks go along whole.

    Raises
    ------
    OSError
        A file cannot be read: it is gone, perhaps with its shape.
    """
    return pickle.dumps((function, tuple(map(_carried, args))), protocol=pickle.HIGHEST_PROTOCOL)


def run_packed(payload: bytes) -> Any:
    """Call a packed function; this module imports little, since each child that runs one loads it."""
    function, args = pickle.loads(payload)  # noqa: S301 - the cluster's own clients are trusted
    return function(*args)


def _carried(argument: Any) -> Any:
    if isinstance(argument, Mapping) and all(isinstance(each, Path) for each in argument.values()):
        return {name: Carried(content=path.read_bytes()) for name, path in argument.items()}
    return argument
