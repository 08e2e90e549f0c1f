"""What `faience compute` does: be a worker of a Dask cluster until a signal comes."""

import asyncio
import signal

from service.commands.failures import CommandFailed
from service.first_run import Report
from service.jobs.cluster_address import checked_address
from service.jobs.compute_worker import offer
from service.settings import Settings
from service.watching.logs import start_logging


def compute_for(cluster: str, threads: int, report: Report) -> None:
    """Compute until SIGINT or SIGTERM.

    Raises
    ------
    CommandFailed
        The address is none.
    """
    try:
        address = checked_address(cluster)
    except ValueError as error:
        raise CommandFailed(str(error)) from None
    start_logging(Settings().log)
    report(f"Computing for {address}, {threads} meshes at a time; Ctrl-C stops.")
    asyncio.run(_until_stopped(address, threads))


async def _until_stopped(address: str, threads: int) -> None:
    stop = asyncio.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        asyncio.get_running_loop().add_signal_handler(number, stop.set)
    await offer(address, threads, stop)
