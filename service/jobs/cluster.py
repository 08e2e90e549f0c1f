"""An executor that has jobs computed by a Dask cluster; imported only where one is configured."""

import asyncio
import threading
from collections.abc import Callable
from concurrent.futures import Executor, Future
from typing import Any, TypeVar
from uuid import uuid4

from distributed.scheduler import KilledWorker

from index.errors import FileMissing
from service.jobs.carrying import packed
from service.jobs.child import ChildError, ChildLimits
from service.jobs.cluster_link import ClusterLink
from service.jobs.computing import compute, release
from service.jobs.dask_manners import teach_dask
from service.jobs.pool import ChildDied, PoolStopped

Value = TypeVar("Value")


class ClusterAway(PoolStopped):
    """The scheduler is away, or lost the job; the job itself is not to blame."""


class Cluster(Executor):
    """Runs each submitted function in a child process of some Dask worker.

    It connects by itself, again and again. A future raises what one of
    `service.jobs.pool.ProcessPerJob` does, and `ClusterAway` where the cluster could not finish the job.

    Parameters
    ----------
    address : str
        Of the scheduler, as in ``tcp://scheduler:8786``.
    limits : ChildLimits
        What each job may use, wherever it runs.
    """

    def __init__(self, address: str, *, limits: ChildLimits) -> None:
        teach_dask(distributed__admin__large_graph_warning_threshold="1TiB")  # a mesh may be large
        self._limits, self._release = limits, release()
        self._link = ClusterLink(address, self._release)
        self._jobs: set[asyncio.Task[Any]] = set()
        self._stopped = self._cancels = False
        started = threading.Event()
        self._thread = threading.Thread(target=lambda: asyncio.run(self._live(started)), name="cluster")
        self._thread.start()
        started.wait()

    def slots(self) -> int:
        """Return how many jobs the cluster takes at the same time now; 0 while it is away."""
        return self._link.slots

    def submit(self, fn: Callable[..., Value], /, *args: Any, **kwargs: Any) -> Future[Value]:
        """Have ``fn(*args)`` computed; ``fn`` is importable by name on the Dask workers."""
        if kwargs:
            raise TypeError("arguments by name do not cross the process border here")
        if self._stopped:
            raise RuntimeError("a cluster that was let go takes no jobs")
        try:
            payload = packed(fn, args)
        except (OSError, FileMissing) as error:
            future: Future[Value] = Future()
            future.set_exception(ChildError(f"{type(error).__name__}: {error}"))
            return future
        return asyncio.run_coroutine_threadsafe(self._compute(payload), self._loop)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Let go of the cluster; with ``cancel_futures`` also of the jobs that run there."""
        if not self._stopped:
            self._stopped, self._cancels = True, cancel_futures
            self._loop.call_soon_threadsafe(self._end.set)
        if wait:
            self._thread.join()

    async def _live(self, started: threading.Event) -> None:
        self._loop, self._end = asyncio.get_running_loop(), asyncio.Event()
        keeper = asyncio.create_task(self._link.keep())
        started.set()
        await self._end.wait()
        if self._cancels:
            for job in self._jobs:
                job.cancel()
        if self._jobs:
            await asyncio.wait(self._jobs)
        keeper.cancel()
        await asyncio.wait([keeper])

    async def _compute(self, payload: bytes) -> Any:
        task = asyncio.current_task()
        if task is not None:
            self._jobs.add(task)
            task.add_done_callback(self._jobs.discard)
        outcome = await self._answer(payload)
        if isinstance(outcome, Exception):
            raise outcome
        return outcome

    async def _answer(self, payload: bytes) -> Any:
        client = self._link.client
        if client is None:
            raise ClusterAway("the cluster is away")
        key, offer = f"faience-{uuid4().hex}", {self._release: 1}
        future = client.submit(compute, self._limits, payload, key=key, resources=offer)
        try:
            return await future
        except KilledWorker as error:  # several in a row died under this very job
            raise ChildDied(None) from error
        except asyncio.CancelledError:
            if self._stopped:
                raise ClusterAway("the cluster was let go") from None
            raise
        except Exception as error:
            self._link.doubt()
            raise ClusterAway(f"the cluster lost the job: {error}") from error
        finally:
            future.release()
