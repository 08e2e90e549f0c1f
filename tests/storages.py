"""Places of files for tests: a folder, or a bucket of an S3 server of the tests' own."""

import hashlib
import logging
import os
import time
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime, timedelta
from pathlib import Path
from urllib.parse import urlsplit

import httpx
import pytest

from index.files import FileStore
from index.local_files import LocalFiles

STORAGES = ("local", "s3")
ACCOUNT_ID = "123456789012"  # whose buckets the server has
KEPT = ("sqlite", "postgresql", "s3")  # SQLite with the last, too
BUCKET = "faience-tests"
# Before any process starts others: what they are to present; the server takes whatever comes.
ENVIRONMENT = {"AWS_ACCESS_KEY_ID": "test", "AWS_SECRET_ACCESS_KEY": "very-secret", "AWS_REGION": "us-east-1"}


class Storages:
    """Where the files of a folder's library are kept; each folder has its own."""

    def __init__(self) -> None:
        self.kind = "local"  # until a test asks for the other
        os.environ.update(ENVIRONMENT)

    def url(self, folder: Path) -> str | None:
        """Return the address of a folder's files; a note in the folder tells where they were before."""
        note = folder / "storage-address"
        if note.exists():
            return note.read_text()
        if self.kind == "local":
            return None
        address = f"s3://{BUCKET}/{hashlib.sha256(str(folder).encode()).hexdigest()[:24]}"
        folder.mkdir(parents=True, exist_ok=True)
        note.write_text(address)
        return address


PLACES = Storages()

# For what only a disk can show: a file that nobody may read, a moment that was long ago.
only_local = pytest.mark.parametrize("storage", ["local"], indirect=True)
only_sqlite = pytest.mark.parametrize("kept", ["sqlite"], indirect=True)
only_folders = pytest.mark.parametrize("kept", ["sqlite", "postgresql"], indirect=True)


def on_disk(files: FileStore) -> LocalFiles:
    """Return the files of a library that are kept in a folder."""
    assert isinstance(files, LocalFiles)
    return files


@contextmanager
def object_storage() -> Iterator[str]:
    """Run a server with an empty bucket; yield its address."""
    from moto.server import ThreadedMotoServer  # takes a second, which few tests need

    logging.getLogger("werkzeug").setLevel(logging.CRITICAL)
    server = ThreadedMotoServer(ip_address="127.0.0.1", port=0, verbose=False)
    server.start()
    host, port = server.get_host_and_port()
    try:
        httpx.put(f"http://{host}:{port}/{BUCKET}").raise_for_status()
        yield f"http://{host}:{port}"
    finally:
        server.stop()


def make_older(files: FileStore, key: str, seconds: float) -> None:
    """Pretend that a file was written so many seconds ago."""
    if files.folder is not None:
        moment = time.time() - seconds
        os.utime(files.folder / key, (moment, moment))
        return
    from moto.s3.models import s3_backends  # the server is in this process, and no request changes its clock

    place = urlsplit(str(files.address(key, 1))).path.removeprefix(f"/{BUCKET}/")
    written = s3_backends[ACCOUNT_ID]["aws"].buckets[BUCKET].keys[place]
    written.last_modified = datetime.now(UTC).replace(tzinfo=None) - timedelta(seconds=seconds)
