import multiprocessing
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest
from sqlalchemy import event

from index.errors import LeaseLost
from index.jobs import MAX_ATTEMPTS, Job
from index.queue import Queue
from index.shapes import Status
from tests.catalogues import FINGERPRINT, HISTOGRAM, WORDS, Opened, add_queued, open_catalogue
from tests.databases import only_on_sqlite

pytestmark = pytest.mark.usefixtures("database")  # on SQLite and on PostgreSQL


class Clock:
    """A clock that stands still until it is moved."""

    def __init__(self) -> None:
        self.moment = datetime(2030, 1, 1, tzinfo=UTC)

    def __call__(self) -> datetime:
        """Tell the time."""
        return self.moment

    def pass_by(self, seconds: float) -> None:
        """Let time pass."""
        self.moment += timedelta(seconds=seconds)


@pytest.fixture
def opened(tmp_path: Path) -> Iterator[Opened]:
    opened = open_catalogue(tmp_path)
    yield opened
    opened.engine.dispose()


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def queue(opened: Opened, clock: Clock) -> Queue:
    return Queue(opened.engine, clock)


def claimed(queue: Queue, worker: str = "w", seconds: float = 60) -> Job:
    job = queue.claim(worker, seconds)
    assert job is not None
    return job


def claim_until_empty(folder: Path, worker: str) -> list[str]:
    opened = open_catalogue(folder)
    shapes = []
    while job := opened.queue.claim(worker, 600):
        shapes.append(job.shape_id)
    opened.engine.dispose()
    return shapes


def test_jobs_are_claimed_oldest_first_and_their_shapes_are_processing(opened: Opened, queue: Queue) -> None:
    for shape_id in ("b", "a"):
        add_queued(opened, shape_id)
    assert queue.depth() == 2
    first, second = claimed(queue, "one"), claimed(queue, "two")
    assert [first.shape_id, second.shape_id] == ["b", "a"]
    assert (first.worker, first.attempts) == ("one", 1)
    assert opened.catalogue.get("b").status == Status.PROCESSING
    assert queue.claim("three", 60) is None
    assert queue.depth() == 0


def test_threads_never_claim_one_job_twice(tmp_path: Path) -> None:
    opened = open_catalogue(tmp_path)
    for number in range(200):
        add_queued(opened, f"s{number:03}")

    def work(worker: int) -> list[str]:
        shapes = []
        while job := opened.queue.claim(f"w{worker}", 600):
            shapes.append(job.shape_id)
        return shapes

    with ThreadPoolExecutor(8) as threads:
        counts = Counter(shape for shapes in threads.map(work, range(8)) for shape in shapes)
    assert len(counts) == 200
    assert set(counts.values()) == {1}
    opened.engine.dispose()


def test_processes_never_claim_one_job_twice(tmp_path: Path) -> None:
    opened = open_catalogue(tmp_path)
    for number in range(200):
        add_queued(opened, f"s{number:03}")
    opened.engine.dispose()
    workers = [f"w{number}" for number in range(3)]
    with ProcessPoolExecutor(3, mp_context=multiprocessing.get_context("spawn")) as processes:
        answers = processes.map(claim_until_empty, [tmp_path] * 3, workers)
        counts = Counter(shape for shapes in answers for shape in shapes)
    assert len(counts) == 200
    assert set(counts.values()) == {1}


def test_a_lease_that_ran_out_is_anothers(opened: Opened, queue: Queue, clock: Clock) -> None:
    add_queued(opened, "a")
    lost = claimed(queue, "slow", 60)
    clock.pass_by(59)
    assert queue.claim("other", 60) is None
    clock.pass_by(2)
    assert queue.depth() == 1
    taken = claimed(queue, "other", 60)
    assert (taken.id, taken.attempts) == (lost.id, 2)
    for refused in (
        lambda: queue.heartbeat(lost, 60),
        lambda: queue.give_back(lost),
        lambda: opened.catalogue.record_failed(lost, code="x", detail="y"),
        lambda: record(opened, lost),
    ):
        with pytest.raises(LeaseLost):
            refused()
    assert opened.catalogue.get("a").status == Status.PROCESSING
    assert record(opened, taken) == Status.READY


def record(opened: Opened, job: Job) -> Status:
    return opened.catalogue.record_ready(
        job,
        facts={},
        fingerprint=FINGERPRINT,
        blocks=HISTOGRAM,
        quantised=WORDS,
        vocabulary_id=opened.vocabulary_id,
    ).status


def test_a_late_result_counts_where_nobody_else_has_taken_the_job(
    opened: Opened, queue: Queue, clock: Clock
) -> None:
    add_queued(opened, "a")
    job = claimed(queue, "slow", 60)
    clock.pass_by(1000)
    assert record(opened, job) == Status.READY
    assert queue.claim("other", 60) is None


def test_a_heartbeat_keeps_the_job(opened: Opened, queue: Queue, clock: Clock) -> None:
    add_queued(opened, "a")
    job = claimed(queue, "w", 60)
    for _ in range(5):
        clock.pass_by(50)
        renewed = queue.heartbeat(job, 60)
        assert renewed.lease_until == clock() + timedelta(seconds=60)
        assert queue.claim("other", 60) is None
    assert (renewed.token, renewed.attempts) == (job.token, 1)


def test_a_job_that_kills_its_workers_is_given_up(opened: Opened, queue: Queue, clock: Clock) -> None:
    add_queued(opened, "killer")
    add_queued(opened, "good")
    for attempt in range(1, MAX_ATTEMPTS + 1):
        assert claimed(queue).attempts == attempt
        if attempt == 1:
            good = claimed(queue, seconds=10_000)
        clock.pass_by(61)
    assert queue.claim("w", 60) is None
    shape = opened.catalogue.get("killer")
    assert (shape.status, shape.error_code) == (Status.FAILED, "gave_up")
    assert queue.depth() == 0
    assert record(opened, good) == Status.READY
    assert opened.catalogue.retry("killer").status == Status.QUEUED
    assert claimed(queue).attempts == 1


def test_the_last_attempt_can_still_succeed(opened: Opened, queue: Queue, clock: Clock) -> None:
    add_queued(opened, "a")
    for _ in range(MAX_ATTEMPTS):
        job = claimed(queue)
        clock.pass_by(61)
    assert record(opened, job) == Status.READY
    assert queue.claim("w", 60) is None
    assert opened.catalogue.get("a").status == Status.READY


def test_giving_back_is_no_attempt(opened: Opened, queue: Queue) -> None:
    add_queued(opened, "a")
    for _ in range(2 * MAX_ATTEMPTS):
        job = claimed(queue)
        assert job.attempts == 1
        queue.give_back(job)
        assert opened.catalogue.get("a").status == Status.QUEUED
    with pytest.raises(LeaseLost):
        queue.heartbeat(job, 60)


@only_on_sqlite
def test_asking_an_empty_queue_locks_nobody_out(opened: Opened, queue: Queue) -> None:
    statements: list[str] = []
    event.listen(opened.engine, "before_cursor_execute", lambda *told: statements.append(told[2]))
    assert queue.claim("w", 60) is None
    assert [statement.split("\n")[0].split()[0] for statement in statements] == ["BEGIN", "SELECT"]
    assert statements[0] == "BEGIN"
