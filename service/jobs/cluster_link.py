"""The connection to a Dask scheduler: made again and again, and followed."""

import asyncio
import contextlib
import logging
from typing import Any

from distributed import Client

log = logging.getLogger(__name__)

LOOK_EVERY = 1.0  # seconds between looks at the cluster, and between attempts to reach it
CONNECT_SECONDS = 5.0  # after which a scheduler that does not answer is taken for away
SILENT_SECONDS = 30.0  # after which a connected one is given up, and the jobs with it
CLOSE_SECONDS = 2.0  # the same for a goodbye


class ClusterLink:
    """Who computes at an address, as far as this release of Faience can use it.

    Parameters
    ----------
    address : str
        Of the scheduler.
    release : str
        The resource that fitting workers offer, as many as they have threads.
    """

    def __init__(self, address: str, release: str) -> None:
        self.client: Client | None = None  # while connected
        self.slots = 0  # jobs that the cluster takes at the same time, now
        self._address, self._release = address, release
        self._said: str | None = None

    async def keep(self) -> None:
        """Stay connected until cancelled."""
        while True:
            client = Client(self._address, asynchronous=True, timeout=CONNECT_SECONDS, set_as_default=False)
            try:
                await client
                self.client = client
                await self._follow(client)
            except (OSError, TimeoutError) as error:  # the address is silent, or it broke off
                log.debug("%s: %s", self._address, error)
            finally:
                self.client, self.slots = None, 0
                await _close(client)
            self._say(logging.WARNING, f"jobs wait: no Dask scheduler answers at {self._address}")
            await asyncio.sleep(LOOK_EVERY)

    def doubt(self) -> None:
        """Take no jobs until the cluster was looked at again: something went wrong there."""
        self.slots = 0

    async def _follow(self, client: Client) -> None:
        while client.status == "running":
            scheduler: Any = client.scheduler  # its methods are the scheduler's, and have no types
            async with asyncio.timeout(SILENT_SECONDS):
                seen = await scheduler.identity(n_workers=-1)
            self._count(seen["workers"].values())
            await asyncio.sleep(LOOK_EVERY)

    def _count(self, workers: Any) -> None:
        offers = [worker["resources"].get(self._release, 0) for worker in workers]
        self.slots = int(sum(offers))
        if self.slots:
            self._say(logging.INFO, f"the cluster at {self._address} describes {self.slots} meshes at a time")
            return
        why = f"its {len(offers)} workers are of other releases" if offers else "it has no workers"
        start = f"`faience compute --cluster {self._address}` of {self._release} starts one"
        self._say(logging.WARNING, f"jobs wait: {why}; {start}")

    def _say(self, level: int, line: str) -> None:
        if line != self._said:
            log.log(level, "%s", line)
        self._said = line


async def _close(client: Client) -> None:
    """Say goodbye, if anybody listens."""
    with contextlib.suppress(OSError, TimeoutError):
        async with asyncio.timeout(CLOSE_SECONDS):
            await client.close()
