"""The worker: claim a job, have it computed, record what came of it."""

import logging
import os
import socket
import threading
import time
from collections.abc import Callable
from concurrent.futures import FIRST_COMPLETED, CancelledError, Executor, Future, wait

from index.errors import (
    CatalogueBusy,
    LeaseLost,
    NewerDescriptions,
    ShapeNotFound,
    StorageFull,
    StorageUnreachable,
)
from index.jobs import Job
from index.vocabulary import Vocabulary
from service.jobs.attempts import Attempt
from service.jobs.child import ChildError
from service.jobs.describing import Describe, InWords, KeptFiles, describe_files, describe_in_words
from service.jobs.ended import RECORDING, EndedJob, JobWatch
from service.jobs.pool import ChildDied, PoolStopped
from service.jobs.recording import (
    GAVE_UP,
    UNEXPECTED,
    UNEXPECTED_DETAIL,
    record_description,
    record_failure,
)
from service.jobs.renewing import Renewing
from service.jobs.sweeping import sweep
from service.jobs.timing import Timed, timed, timing
from service.library import Library
from service.vocabularies import NoVocabulary, own_vocabulary
from service.watching.context import known_as
from worker.describe import Description
from worker.errors import MeshError

log = logging.getLogger(__name__)

Observer = Callable[[str, float], None]  # outcome ("ready", or a code), seconds

Described = Timed[tuple[Description, InWords | None]]

AHEAD = 1  # jobs claimed beyond those that run, so that none waits while others are recorded
TRIES = 2  # of a job whose process dies, in one claim


def process_name() -> str:
    """Return a name for this process's worker, for the log and the queue."""
    return f"{socket.gethostname()}:{os.getpid()}"


class Worker:
    """Takes jobs from a library's queue and runs them on an executor.

    One thread does everything here: it claims, waits, records and keeps the leases alive. The
    computing is the executor's.

    Parameters
    ----------
    executor : Executor
        `service.jobs.pool.ProcessPerJob`, or `service.jobs.cluster.Cluster`.
    slots : int or callable
        Jobs at the same time; a callable is asked each time, and none are claimed while it says 0.
    describe : callable
        What a job is; importable by name.
    observe : callable
        Told of each job's outcome and duration.
    watch : JobWatch
        Hears of the same in more detail.
    """

    def __init__(
        self,
        library: Library,
        executor: Executor,
        *,
        slots: int | Callable[[], int],
        name: str = "worker",
        describe: Describe = describe_files,
        observe: Observer = lambda *_: None,
        watch: JobWatch = JobWatch(),  # noqa: B008 - it holds nothing
    ) -> None:
        self._library, self._executor, self._renewing = library, executor, Renewing(library)
        self._slots = slots if callable(slots) else lambda: slots
        self._name = name
        self._describe, self._observe, self._watch = describe, observe, watch
        self._running: dict[Future[Described], Attempt] = {}
        self._wake, self._stopping = threading.Event(), threading.Event()
        self._next_heartbeat = 0.0
        self._waiting = False  # for room on the disk
        self._finish_until = 0.0  # by the monotonic clock, once it was told to stop
        self.last_step = time.monotonic()  # when it last showed that it is alive

    def run(self) -> None:
        """Clean up after crashes, then work until `stop`; give back what is unfinished."""
        try:
            self._sweep()
            while not self._stopping.is_set():
                try:
                    self._step()
                except Exception:  # a database that is away for a while must not end the worker
                    log.exception("the worker goes on after an error")
                    self._stopping.wait(self._library.settings.poll_seconds)
            self._finish()
        finally:
            self._give_back()

    def _sweep(self) -> None:
        try:
            log.info("swept %d files that no shape needs", sweep(self._library))
        except Exception:
            log.exception("the files could not be swept; the worker goes on")

    def wake(self) -> None:
        """Look for jobs now: one was just accepted in this process."""
        self._wake.set()

    def stop(self, finish_seconds: float = 0) -> None:
        """Ask `run` to claim no more and to end, at once or when its running jobs did within some seconds.

        Asked again, it does not wait for longer.
        """
        if not self._stopping.is_set():
            self._finish_until = time.monotonic() + finish_seconds
        self._stopping.set()
        self._wake.set()

    def _step(self) -> None:
        self._wake.clear()
        self._claim()
        self._settle_finished()

    def _settle_finished(self) -> None:
        self.last_step = time.monotonic()
        for future in self._finished():
            attempt = self._running.pop(future)
            self._settle(future, attempt)
        self._heartbeat()

    def _claim(self) -> None:
        fingerprint = self._library.parameters.fingerprint()
        while self._has_slot() and not self._stopping.is_set() and self._has_room():
            if not self._renewing.may_describe():
                return
            job = self._library.queue.claim(self._name, self._library.settings.lease_seconds, fingerprint)
            if job is None:
                if self._renewing.go_on():
                    continue
                return
            self._watch.claimed(job)
            self._submit(job, tries=1)
            self._heartbeat()  # an executor may take its time

    def _has_slot(self) -> bool:
        slots = self._slots()
        return slots > 0 and len(self._running) < slots + AHEAD

    def _has_room(self) -> bool:
        """Return whether results can be stored: jobs wait, and lose no attempt, while the disk is full."""
        try:
            self._library.check_space(0)
        except StorageFull as error:
            if not self._waiting:
                log.warning("jobs wait: %s", error)
            self._waiting = True
            return False
        self._waiting = False
        return True

    def _submit(self, job: Job, tries: int) -> None:
        library = self._library
        try:
            shape = library.catalogue.get(job.shape_id)
        except ShapeNotFound:  # removed since the claim
            return
        keys = {file.name: file.key for file in shape.files}
        future = self._executor.submit(
            timed,
            describe_in_words,
            self._describe,
            self._vocabulary(),
            KeptFiles(library.files, keys),
            shape.allow_untextured,
            library.parameters,
            library.limits,
        )
        self._running[future] = Attempt(job=job, tries=tries, started=time.monotonic())

    def _vocabulary(self) -> Vocabulary | None:
        try:
            return own_vocabulary(self._library)
        except NoVocabulary:  # may come while the job runs
            return None

    def _finished(self) -> list[Future[Described]]:
        patience = self._library.settings.poll_seconds
        if not self._running:
            self._wake.wait(patience)
            return []
        done, _ = wait(self._running, timeout=patience, return_when=FIRST_COMPLETED)
        return list(done)

    def _settle(self, future: Future[Described], attempt: Attempt) -> None:
        """Record one outcome."""
        with known_as(job_id=attempt.job.id, shape_id=attempt.job.shape_id):
            self._settle_known(future, attempt)

    def _settle_known(self, future: Future[Described], attempt: Attempt) -> None:
        try:
            outcome = self._record(future, attempt)
        except (LeaseLost, ShapeNotFound, NewerDescriptions) as error:
            log.info("job %s is not ours any more: %s", attempt.job.id, error)
            self._watch.lost(attempt.job, error)
            return
        except (StorageFull, StorageUnreachable, CatalogueBusy) as error:
            log.warning("shape %s waits: %s", attempt.job.shape_id, error)
            self._hand_back(attempt.job)
            self._stopping.wait(self._library.settings.lease_seconds / 3)
            return
        if outcome is not None:
            self._observe(outcome, time.monotonic() - attempt.started)
            self._watch.ended(EndedJob.of(attempt.job, outcome, attempt.claimed_at, attempt.stages))

    def _record(self, future: Future[Described], attempt: Attempt) -> str | None:
        job = attempt.job
        try:
            described = future.result()
            attempt.stages.extend(described.stages)
            with timing(RECORDING, attempt.stages):
                record_description(self._library, job, *described.value)
            return "ready"
        except MeshError as error:
            return self._fail(job, error.code, error.detail)
        except (PoolStopped, CancelledError):
            self._hand_back(job)
            return None
        except ChildDied as error:
            return self._retry(attempt, str(error))
        except ChildError as error:
            code = self._fail(job, UNEXPECTED, UNEXPECTED_DETAIL)  # raises where the shape was removed: its
            log.error("describing shape %s failed unexpectedly:\n%s", job.shape_id, error)  # files are gone
            return code

    def _retry(self, attempt: Attempt, reason: str) -> str | None:
        log.warning("shape %s, try %d: %s", attempt.job.shape_id, attempt.tries, reason)
        if attempt.tries < TRIES:
            self._submit(attempt.job, attempt.tries + 1)
            return None
        return self._fail(attempt.job, GAVE_UP, f"{reason}, {attempt.tries} times in a row")

    def _fail(self, job: Job, code: str, detail: str) -> str:
        record_failure(self._library, job, code, detail)
        return code

    def _heartbeat(self) -> None:
        """Prolong the leases three times in their length; forget jobs that were lost."""
        if time.monotonic() < self._next_heartbeat:
            return
        lease = self._library.settings.lease_seconds
        self._next_heartbeat = time.monotonic() + lease / 3
        for future, attempt in list(self._running.items()):
            try:
                self._library.queue.heartbeat(attempt.job, lease)
            except LeaseLost as error:
                future.cancel()
                del self._running[future]
                self._watch.lost(attempt.job, error)
            except (StorageFull, CatalogueBusy) as error:
                log.warning("the lease of job %s could not be prolonged: %s", attempt.job.id, error)

    def _finish(self) -> None:
        """Record what still runs, until the time is over; what has not begun goes back at once."""
        try:
            while self._running and time.monotonic() < self._finish_until:
                for future in [future for future in self._running if future.cancel()]:
                    self._hand_back(self._running.pop(future).job)
                self._settle_finished()
        except Exception:  # what is left goes back, as without this time
            log.exception("the worker could not finish its jobs")

    def _hand_back(self, job: Job) -> None:
        self._library.reserve.despite_full_disk(lambda: self._library.queue.give_back(job))

    def _give_back(self) -> None:
        for future, attempt in self._running.items():
            future.cancel()
            try:
                self._hand_back(attempt.job)
            except Exception:
                log.exception("job %s could not be given back; its lease will run out", attempt.job.id)
        self._running.clear()
