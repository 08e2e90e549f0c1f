"""A Dask worker that describes meshes: it computes in children, and waits for its scheduler."""

import asyncio
import contextlib
import logging
from urllib.parse import urlsplit

from distributed import Worker

from service.jobs.child import ChildLimits
from service.jobs.computing import release
from service.jobs.dask_manners import teach_dask
from service.jobs.pool import ProcessPerJob

log = logging.getLogger(__name__)

RETRY_SECONDS = 1.0  # between attempts to reach the scheduler
CONNECT_SECONDS = 10.0  # after which it is taken for away
CLOSE_SECONDS = 10.0  # for telling the scheduler that others have to take over


async def offer(address: str, threads: int, stop: asyncio.Event) -> None:
    """Compute for a cluster until ``stop`` is set; join it again whenever its scheduler is back.

    Parameters
    ----------
    address : str
        Of the scheduler.
    threads : int
        Jobs at the same time.
    """
    # its threads only wait for children, and nothing of it is served over HTTP
    teach_dask(distributed__worker__profile__enabled=False, distributed__worker__http__routes=[])
    _warm()
    stopping = asyncio.create_task(stop.wait())
    silent = False
    while not stop.is_set():
        if await _answers(address):
            silent = False
            joined = asyncio.create_task(_join(address, threads))
            await asyncio.wait([joined, stopping], return_when=asyncio.FIRST_COMPLETED)
            joined.cancel()
            await asyncio.wait([joined])
        elif not silent:
            silent = True
            log.warning("no Dask scheduler answers at %s; it is waited for", address)
        await asyncio.wait([stopping], timeout=RETRY_SECONDS)


def _warm() -> None:
    """Start the fork server, which is the process's: pools and their limits come with the jobs."""
    ProcessPerJob(slots=1, limits=ChildLimits(memory_bytes=0, cpu_seconds=0, wall_seconds=0)).warm()


async def _answers(address: str) -> bool:
    """Return whether anybody listens there."""
    place = urlsplit(address)
    try:
        async with asyncio.timeout(CONNECT_SECONDS):
            _, writer = await asyncio.open_connection(place.hostname, place.port)
            writer.close()
            await writer.wait_closed()
    except (OSError, TimeoutError):
        return False
    return True


async def _join(address: str, threads: int) -> None:
    """Be a worker of the cluster until its scheduler leaves, or this is cancelled."""
    worker = Worker(
        address,
        nthreads=threads,
        resources={release(): threads},
        memory_limit=0,  # the children have limits of their own
        death_timeout=CONNECT_SECONDS,
    )
    try:
        await worker
        log.info("computing for the cluster at %s, %d meshes at a time, as %s", address, threads, release())
        await worker.finished()
        log.warning("the scheduler at %s left; it is waited for", address)
    except (OSError, TimeoutError, RuntimeError) as error:  # Dask wraps what fails at the start
        log.warning("the cluster at %s cannot be joined: %s", address, error)
    finally:
        await _leave(worker)


async def _leave(worker: Worker) -> None:
    """Let the scheduler give what runs here to others; then the children are killed."""
    with contextlib.suppress(OSError, TimeoutError):
        async with asyncio.timeout(CLOSE_SECONDS):
            await worker.close_gracefully(reason="it was stopped")
    await worker.close(reason="it was stopped")
