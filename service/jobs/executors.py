"""Where a library's jobs are computed: in processes of this machine, or on a cluster."""

from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass

from service.jobs.child import ChildLimits
from service.jobs.pool import ProcessPerJob
from service.settings import Settings


@dataclass(frozen=True, kw_only=True)
class Computing:
    """What runs jobs."""

    executor: Executor  # its `shutdown(cancel_futures=True)` ends them
    slots: Callable[[], int]  # jobs that it takes at the same time, now


def child_limits(settings: Settings) -> ChildLimits:
    """Return what one job may use."""
    return ChildLimits(
        memory_bytes=settings.job_memory_bytes,
        cpu_seconds=settings.job_cpu_seconds,
        wall_seconds=settings.job_seconds,
    )


def start_computing(settings: Settings, slots: int) -> Computing:
    """Start what runs a library's jobs.

    Parameters
    ----------
    slots : int
        Jobs at the same time on this machine; a cluster knows itself how many it takes.
    """
    limits = child_limits(settings)
    if settings.cluster is not None:
        from service.jobs.cluster import Cluster  # takes a second, and few need it

        cluster = Cluster(settings.cluster, limits=limits)
        return Computing(executor=cluster, slots=cluster.slots)
    pool = ProcessPerJob(slots=slots, limits=limits)
    pool.warm()
    return Computing(executor=pool, slots=lambda: slots)
