"""A full disk, named: the one place that tells it from other failures of the file system."""

import errno
from collections.abc import Iterator
from contextlib import contextmanager

from index.errors import StorageFull

_FULL = frozenset({errno.ENOSPC, errno.EDQUOT})


@contextmanager
def full_disk_named() -> Iterator[None]:
    """Turn the operating system's "no space" and "over quota" into StorageFull."""
    try:
        yield
    except OSError as error:
        if error.errno in _FULL:
            raise StorageFull("the disk is full; nothing of this file was kept") from error
        raise
