"""A disk that somebody else fills to the last byte, under a running service."""

import contextlib
import os
import subprocess
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import httpx

from soak.clients import form
from soak.parcels import kind_of, parcel
from soak.processes import ending, free_port, serve, start, wait_until

SIZE = 64 * 2**20  # bytes of the disk
ENVIRONMENT = {
    "FAIENCE_RESERVE_BYTES": str(4 * 2**20),
    "FAIENCE_POLL_SECONDS": "0.1",
    "FAIENCE_LEASE_SECONDS": "3",  # the killed service's jobs are soon others'
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
}
GOOD = [number for number in range(1, 40) if kind_of(number) != "empty"]
READY, WAITING, LATER = GOOD[:4], GOOD[4:8], GOOD[8]
PIECE = 64 * 2**10  # bytes of ballast at once


class NoSmallDisk(Exception):
    """A disk of a few megabytes cannot be mounted here."""


@dataclass(frozen=True, kw_only=True)
class FullDiskFigures:
    """What the service did while its disk was full, and afterwards."""

    full: dict[str, int]  # call → status while not a byte was free
    restarted: dict[str, int]  # the same after it was killed and started again, still full
    seconds_to_recover: float  # from the first free byte to an accepted upload, without a restart
    states: dict[str, str]  # name → state at the end


@contextlib.contextmanager
def small_disk(folder: Path, size: int = SIZE) -> Iterator[Path]:
    """Mount a disk in memory; NoSmallDisk without the rights to."""
    folder.mkdir(parents=True, exist_ok=True)
    made = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", f"size={size}", "faience-soak", folder],  # noqa: S607 - wherever it is
        capture_output=True,
        check=False,
    )
    if made.returncode != 0:
        raise NoSmallDisk(made.stderr.decode(errors="replace").strip())
    try:
        yield folder
    finally:
        subprocess.run(["umount", "--lazy", folder], check=True)  # noqa: S607 - as above


def run(library: Path) -> FullDiskFigures:
    """Fill the disk while jobs wait; ask, remove, kill, start again, free it, and wait.

    Parameters
    ----------
    library : Path
        On a small disk of its own.
    """
    port, ballast = free_port(), library / "somebody-elses"
    service = serve(library, port, 1, ENVIRONMENT)
    service.log = library.parent / f"{library.name}.log"  # on another disk
    with ending(service), httpx.Client(base_url=f"http://127.0.0.1:{port}", timeout=60) as client:
        start(service, port)
        ready = [_upload(client, number).json()["id"] for number in READY]
        wait_until(lambda: not _open_jobs(client), "the first shapes")
        for number in WAITING:
            _upload(client, number)
        _fill(ballast)
        full = _statuses(client, ready[0], ready[1])
        service.kill()
        _fill(ballast)  # what the removal freed
        start(service, port)
        restarted = _statuses(client, ready[0], ready[2])
        ballast.unlink()
        seconds = _seconds_to_recover(client)
        wait_until(lambda: not _open_jobs(client), "the end of every job")
        items = client.get("/v1/shapes").json()["items"]
        service.stop()
    return FullDiskFigures(
        full=full,
        restarted=restarted,
        seconds_to_recover=seconds,
        states={item["name"]: item["status"] for item in items},
    )


def _upload(client: httpx.Client, number: int) -> httpx.Response:
    return client.post("/v1/shapes", files=form(parcel(number)))


def _fill(ballast: Path) -> None:
    """Write until the disk takes no more."""
    with ballast.open("ab", buffering=0) as file:
        for size in (PIECE, 1):
            with contextlib.suppress(OSError):
                while file.write(os.urandom(size)):
                    pass


def _statuses(client: httpx.Client, kept: str, removed: str) -> dict[str, int]:
    """Return what each kind of call is answered with."""
    return {
        "upload": _upload(client, LATER).status_code,
        "list": client.get("/v1/shapes").status_code,
        "similar": client.get(f"/v1/shapes/{kept}/similar").status_code,
        "thumbnail": client.get(f"/v1/shapes/{kept}/thumbnail.png").status_code,
        "remove": client.delete(f"/v1/shapes/{removed}").status_code,
        "upload after a removal": _upload(client, LATER).status_code,
    }


def _seconds_to_recover(client: httpx.Client) -> float:
    began = time.monotonic()
    wait_until(lambda: _upload(client, LATER).is_success, "an accepted upload")
    return time.monotonic() - began


def _open_jobs(client: httpx.Client) -> bool:
    items = client.get("/v1/shapes").json()["items"]
    return any(item["status"] in ("queued", "processing") for item in items)
