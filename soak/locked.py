"""A catalogue that another process keeps locked, under a running service."""

import contextlib
import sqlite3
import time
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import httpx

from soak.clients import form
from soak.parcels import parcel
from soak.processes import ending, free_port, serve, start, wait_until
from soak.small_disk import GOOD

READY = GOOD[0]
WRITERS = 60  # uploads at the same time: more than threads that a service has for anything else
ENVIRONMENT = {
    "FAIENCE_BUSY_SECONDS": "4",
    "FAIENCE_POLL_SECONDS": "0.1",
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
}


@dataclass(frozen=True, kw_only=True)
class LockedFigures:
    """What was answered while nobody could write."""

    uploads: Counter[int]  # status → how many
    codes: Counter[str]  # of the refusals
    reads: Counter[int]  # status → how many
    slowest_read: float  # seconds
    seconds: float  # until every upload was answered
    afterwards: int  # status of the same upload when the lock was gone
    kept: int  # shapes at the end


def run(folder: Path) -> LockedFigures:
    """Lock the catalogue, send more uploads than there are threads, and read all the while.

    Parameters
    ----------
    folder : Path
        An empty place for the library.
    """
    port, library = free_port(), folder / "library"
    service = serve(library, port, 1, ENVIRONMENT)
    url = f"http://127.0.0.1:{port}"
    with ending(service), httpx.Client(base_url=url, timeout=120) as client:
        start(service, port)
        shape = client.post("/v1/shapes", files=form(parcel(READY))).json()
        wait_until(lambda: _status(client, shape["id"]) == "ready", "a ready shape")
        began = time.monotonic()
        with _locked(library / "catalogue.sqlite3"), ThreadPoolExecutor(WRITERS) as writers:
            sent = [writers.submit(_upload, url, number) for number in GOOD[1:2] * WRITERS]
            reads = []
            while not all(upload.done() for upload in sent):
                reads.append(_read(client, shape["id"]))
                time.sleep(0.1)
            seconds = time.monotonic() - began
        uploads = [upload.result() for upload in sent]
        afterwards = _upload(url, GOOD[1]).status_code
        kept = len(client.get("/v1/shapes").json()["items"])
        service.stop()
    return LockedFigures(
        uploads=Counter(answer.status_code for answer in uploads),
        codes=Counter(answer.json().get("code", "none") for answer in uploads),
        reads=Counter(status for status, _ in reads),
        slowest_read=max(took for _, took in reads),
        seconds=seconds,
        afterwards=afterwards,
        kept=kept,
    )


@contextlib.contextmanager
def _locked(database: Path) -> Iterator[None]:
    """Hold the database's only place for a writer."""
    with contextlib.closing(sqlite3.connect(database, isolation_level=None)) as connection:
        connection.execute("BEGIN IMMEDIATE")
        yield
        connection.execute("ROLLBACK")


def _upload(url: str, number: int) -> httpx.Response:
    return httpx.post(f"{url}/v1/shapes", files=form(parcel(number)), timeout=120)


def _status(client: httpx.Client, shape_id: str) -> str:
    return str(client.get(f"/v1/shapes/{shape_id}").json()["status"])


def _read(client: httpx.Client, shape_id: str) -> tuple[int, float]:
    began = time.monotonic()
    statuses = {client.get(path).status_code for path in ("/v1/shapes", f"/v1/shapes/{shape_id}/similar")}
    return max(statuses), time.monotonic() - began
