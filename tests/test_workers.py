"""Every job ends, and one bad mesh harms only itself."""

import threading
import time
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest

from index.errors import CatalogueBusy, StorageFull, StorageUnreachable
from index.jobs import Job
from index.shapes import Status
from service.jobs.attempts import Attempt
from service.jobs.child import ChildError
from service.jobs.ended import EndedJob, JobWatch
from service.jobs.executors import child_limits
from service.jobs.pool import ProcessPerJob
from service.jobs.workers import Worker
from service.library import Library
from service.retrieval import remove_shape
from tests.fakes import coloured_triangle, describe_quickly
from tests.serving import open_fake_library, settings_for, wait_until
from tests.working import SameThread, Working, accept, settled
from worker.errors import Code, MeshError

pytestmark = pytest.mark.usefixtures("kept")  # on SQLite and on PostgreSQL, and with files in a bucket


@pytest.fixture
def library(tmp_path: Path, request: pytest.FixtureRequest) -> Iterator[Library]:
    lease: float = getattr(request, "param", 0.5)
    settings = settings_for(tmp_path / "library", lease_seconds=lease, job_seconds=3)
    opened = open_fake_library(settings)
    yield opened
    opened.close()


@pytest.fixture
def pool(library: Library) -> Iterator[ProcessPerJob]:
    made = ProcessPerJob(slots=2, limits=child_limits(library.settings))
    yield made
    made.shutdown(cancel_futures=True)


def test_a_shape_removed_while_it_is_described_is_no_defect(
    library: Library, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level("INFO")
    gone = accept(library, "gone.ply")
    job = library.queue.claim("worker", 60)
    assert job is not None
    remove_shape(library, gone)
    described: Future[Any] = Future()
    described.set_exception(ChildError("FileNotFoundError: its files are gone"))
    worker = Worker(library, SameThread(), slots=1, name="worker")
    worker._settle(described, Attempt(job=job, tries=1, started=0))  # step by step: no clock decides
    assert any("is not ours any more" in line for line in caplog.messages)
    assert not [record for record in caplog.records if record.levelname == "ERROR"]


@pytest.mark.parametrize(
    ("name", "code"),
    [
        ("crash.ply", "gave_up"),
        ("hang.ply", "too_complex"),
        ("eat.ply", "too_complex"),
        ("defect.ply", "unexpected"),
    ],
)
def test_a_child_that_goes_wrong_costs_its_own_job_alone(
    library: Library, pool: ProcessPerJob, name: str, code: str
) -> None:
    good = [accept(library, "first.ply", coloured_triangle(1))]
    bad = accept(library, name)
    good += [accept(library, f"{number}.ply", coloured_triangle(number)) for number in (2, 3)]
    with Working(library, pool) as working:
        failed = settled(library, bad)
        assert (failed.status, failed.error_code) == (Status.FAILED, code)
        assert [settled(library, shape_id).status for shape_id in good] == [Status.READY] * 3
    assert sorted(working.outcomes) == sorted([code, "ready", "ready", "ready"])


def test_a_detail_shows_no_traceback(library: Library) -> None:
    bad = accept(library, "defect.ply")
    pool = ProcessPerJob(slots=1, limits=child_limits(library.settings))
    with Working(library, pool):
        detail = settled(library, bad).error_detail or ""
    pool.shutdown()
    assert "Traceback" not in detail
    assert "KeyError" not in detail


def test_a_job_of_a_dead_worker_is_taken_up_after_its_lease(library: Library, pool: ProcessPerJob) -> None:
    shape_id = accept(library, "a.ply")
    assert library.queue.claim("killed", 0.3) is not None  # and nothing is ever heard of it again
    with Working(library, pool):
        assert settled(library, shape_id).status == Status.READY


@pytest.mark.parametrize("library", [3.0], indirect=True)  # a heartbeat a second: a busy machine keeps it
def test_a_long_job_keeps_its_lease(library: Library) -> None:
    shape_id = accept(library, "a.ply")
    release = threading.Event()

    class Slow(SameThread):
        def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
            future: Future[Any] = Future()

            def run() -> None:
                release.wait()
                future.set_result(fn(*args, **kwargs))

            threading.Thread(target=run, daemon=True).start()
            return future

    with Working(library, Slow()):
        wait_until(lambda: library.catalogue.get(shape_id).status == Status.PROCESSING)
        end = time.monotonic() + 2 * library.settings.lease_seconds
        while time.monotonic() < end:
            assert library.queue.claim("thief", 1) is None
            time.sleep(0.1)
        release.set()
        assert settled(library, shape_id).status == Status.READY


def test_stopping_gives_unfinished_jobs_back_at_once(library: Library, pool: ProcessPerJob) -> None:
    shape_id = accept(library, "hang.ply")
    with Working(library, pool):
        wait_until(lambda: library.catalogue.get(shape_id).status == Status.PROCESSING)
    assert library.catalogue.get(shape_id).status == Status.QUEUED
    job = library.queue.claim("next", 1)
    assert job is not None
    assert job.attempts == 1  # the one that was stopped does not count


def test_with_time_to_finish_running_jobs_end_and_the_others_go_back(library: Library) -> None:
    begun, release = threading.Event(), threading.Event()

    def describe(*args: Any) -> Any:
        begun.set()
        release.wait(60)
        return describe_quickly(*args)

    running, waiting = accept(library, "a.ply"), accept(library, "b.ply", coloured_triangle(9))
    with ThreadPoolExecutor(1) as one, Working(library, one, describe=describe) as working:
        begun.wait(60)
        wait_until(lambda: library.catalogue.get(waiting).status == Status.PROCESSING)  # claimed ahead
        working.finish_seconds = 3600
        working.worker.stop(3600)
        wait_until(lambda: library.catalogue.get(waiting).status == Status.QUEUED)
        assert library.catalogue.get(running).status == Status.PROCESSING
        release.set()
    assert library.catalogue.get(running).status == Status.READY
    job = library.queue.claim("next", 1)
    assert job is not None
    assert (job.shape_id, job.attempts) == (waiting, 1)


def test_the_time_to_finish_ends(library: Library, pool: ProcessPerJob) -> None:
    shape_id = accept(library, "hang.ply")
    with Working(library, pool) as working:
        wait_until(lambda: library.catalogue.get(shape_id).status == Status.PROCESSING)
        working.finish_seconds = 0.1
    assert library.catalogue.get(shape_id).status == Status.QUEUED


def test_the_watch_hears_of_claims_ends_and_stages(library: Library) -> None:
    class Heard(JobWatch):
        def __init__(self) -> None:
            self.claims: list[str] = []
            self.ends: list[EndedJob] = []

        def claimed(self, job: Job) -> None:
            self.claims.append(job.shape_id)

        def ended(self, job: EndedJob) -> None:
            self.ends.append(job)

    def describe(files: Mapping[str, bytes], *args: Any) -> Any:
        if "b.ply" in files:
            raise MeshError(Code.ZERO_AREA, "nothing is left")
        return describe_quickly(files, *args)

    good, bad = accept(library, "a.ply"), accept(library, "b.ply", coloured_triangle(9))
    heard = Heard()
    with Working(library, SameThread(), watch=heard, describe=describe):
        settled(library, bad)
        wait_until(lambda: len(heard.ends) == 2)
    assert heard.claims == [good, bad]
    ends = {each.job.shape_id: each for each in heard.ends}  # in either order
    assert (ends[good].outcome, ends[bad].outcome) == ("ready", "zero_area")
    assert [each.name for each in ends[good].stages] == ["recording"]  # these descriptions tell none
    assert ends[good].claimed_at <= ends[good].ended_at


def test_a_shape_removed_while_it_is_described_leaves_no_files(library: Library) -> None:
    removed = accept(library, "a.ply")
    other = accept(library, "b.ply", coloured_triangle(9))

    def describe(files: Mapping[str, bytes], *args: Any) -> Any:
        description = describe_quickly(files, *args)
        if "a.ply" in files:
            remove_shape(library, removed)
        return description

    with Working(library, SameThread(), describe=describe):
        assert settled(library, other).status == Status.READY
    assert list(library.files.keys(f"shapes/{removed}")) == []
    assert library.catalogue.get_many([removed]) == {}


def test_a_full_disk_delays_a_result_and_loses_nothing(
    library: Library, monkeypatch: pytest.MonkeyPatch
) -> None:
    shape_id = accept(library, "a.ply")
    put, refusals = (
        library.files.put,
        [StorageFull("full"), CatalogueBusy("locked"), StorageUnreachable("away")],
    )

    def sometimes_full(key: str, data: bytes) -> None:
        if refusals:
            raise refusals.pop()
        put(key, data)

    monkeypatch.setattr(library.files, "put", sometimes_full)
    with Working(library, SameThread()):
        assert settled(library, shape_id).status == Status.READY
    assert refusals == []


def test_an_error_of_the_queue_does_not_end_the_worker(
    library: Library, monkeypatch: pytest.MonkeyPatch
) -> None:
    shape_id = accept(library, "a.ply")
    claim, errors = library.queue.claim, [OSError("away"), OSError("still away")]

    def sometimes_away(*args: Any) -> Any:
        if errors:
            raise errors.pop()
        return claim(*args)

    monkeypatch.setattr(library.queue, "claim", sometimes_away)
    with Working(library, SameThread()):
        assert settled(library, shape_id).status == Status.READY


@pytest.mark.parametrize("library", [60.0], indirect=True)  # a lease that no busy machine lets run out
def test_two_workers_never_describe_the_same_shape_twice(library: Library) -> None:
    counted: list[str] = []

    def describe(files: Mapping[str, bytes], *args: Any) -> Any:
        counted.append(next(iter(files)))
        return describe_quickly(files, *args)

    ids = [accept(library, f"{number}.ply", coloured_triangle(number)) for number in range(12)]
    with Working(library, SameThread(), describe=describe), Working(library, SameThread(), describe=describe):
        assert {settled(library, shape_id).status for shape_id in ids} == {Status.READY}
    assert sorted(counted) == sorted(f"{number}.ply" for number in range(12))
