"""The temporary place of uploads: a folder of this process, swept when its process is gone."""

import contextlib
import fcntl
import shutil
import uuid
from collections.abc import Iterator
from io import TextIOWrapper
from pathlib import Path


class Incoming:
    """Temporary folders inside the data folder, so that a disk's fullness is noticed before a reply.

    Each process keeps its own folder and a lock on it; what a killed process left is deleted by the next
    one that starts, which can take the dead one's lock.

    Parameters
    ----------
    root : Path
        The folder that all processes of one data folder share.
    """

    def __init__(self, root: Path) -> None:
        root.mkdir(parents=True, exist_ok=True)
        self._lock = (root / ".sweep").open("w")
        with _locked(self._lock):
            for folder in root.iterdir():
                if folder.is_dir() and _abandoned(folder):
                    shutil.rmtree(folder, ignore_errors=True)
            self.folder = root / uuid.uuid4().hex
            self.folder.mkdir()
            self._owner = (self.folder / ".lock").open("w")
            fcntl.flock(self._owner, fcntl.LOCK_EX)

    @contextlib.contextmanager
    def scratch(self) -> Iterator[Path]:
        """Lend an empty folder that is gone afterwards, whatever happened."""
        folder = self.folder / uuid.uuid4().hex
        folder.mkdir()
        try:
            yield folder
        finally:
            shutil.rmtree(folder, ignore_errors=True)

    def close(self) -> None:
        """Delete this process's folder."""
        shutil.rmtree(self.folder, ignore_errors=True)
        self._owner.close()
        self._lock.close()


@contextlib.contextmanager
def _locked(file: TextIOWrapper) -> Iterator[None]:
    fcntl.flock(file, fcntl.LOCK_EX)
    try:
        yield
    finally:
        fcntl.flock(file, fcntl.LOCK_UN)


def _abandoned(folder: Path) -> bool:
    try:
        with (folder / ".lock").open("r+") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except FileNotFoundError:
        return True
    return True
