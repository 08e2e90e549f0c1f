"""What a worker of a Dask cluster runs: one job, in a child of its own as in the local pool."""

from concurrent.futures import Future, wait
from importlib.metadata import version
from typing import Any

from distributed import get_worker

from index.errors import StorageUnreachable
from service.jobs.carrying import run_packed
from service.jobs.child import ChildError, ChildLimits
from service.jobs.pool import ChildDied, PoolStopped, ProcessPerJob
from worker.errors import MeshError
from worker.parameters import Parameters

LOOK_EVERY = 0.2  # seconds between looks whether the job is still wanted
OUTCOMES = (MeshError, ChildError, ChildDied, PoolStopped, StorageUnreachable)  # what a pool's future raises
RUNNING = ("running", "paused", "closing_gracefully")  # a Dask worker that can still answer


def release() -> str:
    """Return what two machines must agree on: the version, and the numbers of the descriptors.

    A Dask worker offers a resource of this name and a job asks for it, so that no job comes to a worker
    whose description the library would refuse.
    """
    return f"faience-{version('faience')}-{Parameters().fingerprint()}"


def compute(limits: ChildLimits, payload: bytes) -> Any:
    """Run a packed function within limits; the child is killed when nobody waits for it any more.

    Parameters
    ----------
    payload : bytes
        From `service.jobs.carrying.packed`. Only the child opens it: what is wrong with it harms one job.

    Returns
    -------
    object
        The function's value, or one of ``OUTCOMES``, which the asker raises.
    """
    pool = ProcessPerJob(slots=1, limits=limits)
    try:
        return _outcome(pool.submit(run_packed, payload))
    finally:
        pool.shutdown(cancel_futures=True)


def _outcome(job: Future[Any]) -> Any:
    worker = get_worker()
    key = worker.get_current_task()
    while not wait([job], timeout=LOOK_EVERY).done:
        task = worker.state.tasks.get(key)
        if task is None or task.state == "cancelled" or worker.status.name not in RUNNING:
            return PoolStopped()
    try:
        return job.result()
    except OUTCOMES as outcome:
        return outcome
