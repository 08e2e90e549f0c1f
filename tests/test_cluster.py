"""A job on a cluster can only harm itself, and a lost machine or scheduler costs time, never a shape."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from index.shapes import Status
from service.jobs.child import ChildError, ChildLimits
from service.jobs.cluster import Cluster
from service.jobs.pool import ChildDied, PoolStopped
from service.library import Library
from soak.processes import Command, alive, ending, free_port
from tests import children
from tests.clusters import Machines, listens_at, machines, takes
from tests.commanding import json_lines, make_meshes, make_quick, run
from tests.fakes import coloured_triangle
from tests.gates import Gate
from tests.serving import open_fake_library, settings_for, wait_until
from tests.working import Working, accept, settled
from worker.errors import Code, MeshError

LIMITS = ChildLimits(memory_bytes=2**30, cpu_seconds=60, wall_seconds=120)
IMPATIENT = ChildLimits(memory_bytes=2**30, cpu_seconds=60, wall_seconds=0.3)
SLOTS = 3  # of the two machines together


@pytest.fixture(scope="module")
def running(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Machines]:
    with machines(tmp_path_factory.mktemp("cluster"), 2, 1) as started:
        yield started


@pytest.fixture
def cluster(running: Machines) -> Iterator[Cluster]:
    for machine in (running.scheduler, *running.computers):
        if not machine.running():
            machine.start()
    made = Cluster(running.address, limits=LIMITS)
    takes(made, SLOTS)
    yield made
    made.shutdown(cancel_futures=True)


@pytest.fixture
def library(tmp_path: Path) -> Iterator[Library]:
    opened = open_fake_library(settings_for(tmp_path / "library"))
    yield opened
    opened.close()


@pytest.fixture
def gate(tmp_path: Path) -> Gate:
    folder = tmp_path / "gate"
    folder.mkdir()
    return Gate(folder)


def batch(library: Library, count: int = 6) -> list[str]:
    return [accept(library, f"{number}.ply", coloured_triangle(number)) for number in range(count)]


def working(library: Library, cluster: Cluster, gate: Gate) -> Working:
    return Working(library, cluster, describe=gate.describe, slots=cluster.slots)


def test_values_come_back_each_from_a_process_of_its_own(cluster: Cluster) -> None:
    assert cluster.submit(children.add, 2, 3).result() == 5
    assert len(cluster.submit(children.return_much, 20_000_000).result()) == 20_000_000
    assert len({cluster.submit(children.identify).result() for _ in range(3)}) == 3


def test_a_machine_listens_only_where_its_scheduler_is(running: Machines, cluster: Cluster) -> None:
    for machine in running.computers:
        assert listens_at(machine.pid) == {"127.0.0.1"}


def test_what_goes_wrong_is_told_as_by_the_local_pool(cluster: Cluster) -> None:
    crash, refusal = cluster.submit(children.exit_at_once, 3), cluster.submit(children.refuse)
    defect, greedy = cluster.submit(children.have_a_defect), cluster.submit(children.eat_memory)
    with pytest.raises(ChildDied, match="exit code 3") as died:
        crash.result()
    assert died.value.exit_code == 3
    with pytest.raises(MeshError, match="points only") as refused:
        refusal.result()
    assert refused.value.code == Code.NO_FACES
    with pytest.raises(ChildError, match="KeyError"):
        defect.result()
    with pytest.raises(MeshError, match="1024 MiB"):
        greedy.result()
    assert cluster.submit(children.add, 1, 1).result() == 2


def test_limits_come_with_the_job(running: Machines) -> None:
    impatient = Cluster(running.address, limits=IMPATIENT)
    takes(impatient, SLOTS)
    try:
        with pytest.raises(MeshError, match=r"0\.3 s") as caught:
            impatient.submit(children.hang).result()
        assert caught.value.code == Code.TOO_COMPLEX
    finally:
        impatient.shutdown(cancel_futures=True)


def test_a_job_that_nobody_waits_for_is_killed_where_it_runs(cluster: Cluster, tmp_path: Path) -> None:
    mark = tmp_path / "pid"
    job = cluster.submit(children.write_identity_and_hang, mark)
    wait_until(mark.exists)
    job.cancel()
    wait_until(lambda: not alive(int(mark.read_text())))


def test_letting_go_of_the_cluster_says_that_the_job_is_not_to_blame(
    running: Machines, tmp_path: Path
) -> None:
    cluster, mark = Cluster(running.address, limits=LIMITS), tmp_path / "pid"
    takes(cluster, SLOTS)
    job = cluster.submit(children.write_identity_and_hang, mark)
    wait_until(mark.exists)
    cluster.shutdown(cancel_futures=True)
    with pytest.raises(PoolStopped):
        job.result(timeout=0)
    wait_until(lambda: not alive(int(mark.read_text())))
    with pytest.raises(RuntimeError):
        cluster.submit(children.add, 1, 1)


def test_a_scheduler_killed_in_mid_batch_costs_no_shape(
    running: Machines, library: Library, cluster: Cluster, gate: Gate, caplog: pytest.LogCaptureFixture
) -> None:
    ids = batch(library)
    with working(library, cluster, gate) as worker:
        wait_until(lambda: gate.tried() == SLOTS)
        running.scheduler.kill()
        takes(cluster, 0)
        wait_until(lambda: library.queue.depth() == 6)  # given back, and not claimed again
        gate.open()
        running.scheduler.start()
        assert {settled(library, shape_id).status for shape_id in ids} == {Status.READY}
    assert worker.outcomes == ["ready"] * 6
    assert f"jobs wait: no Dask scheduler answers at {running.address}" in caplog.messages


def test_stopping_gives_back_what_the_cluster_computes(
    library: Library, cluster: Cluster, gate: Gate
) -> None:
    (shape_id,) = batch(library, 1)
    with working(library, cluster, gate):
        wait_until(lambda: gate.tried() == 1)
    assert library.catalogue.get(shape_id).status == Status.QUEUED
    job = library.queue.claim("next", 60)
    assert job is not None
    assert job.attempts == 1


def test_a_command_indexes_on_the_cluster(
    running: Machines, cluster: Cluster, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    make_quick(monkeypatch)
    make_meshes(tmp_path / "meshes", 4)
    result = run(
        "index", tmp_path / "meshes", "--data-dir", tmp_path / "new", "--cluster", running.address, "--json"
    )
    assert result.exit_code == 0, result.stderr
    *outcomes, sums = json_lines(result)
    assert {outcome["outcome"] for outcome in outcomes} == {"accepted"}
    assert sums["accepted"] == 4


def test_a_worker_command_describes_on_the_cluster(
    running: Machines, library: Library, cluster: Cluster, tmp_path: Path
) -> None:
    shape_id = accept(library, "a.ply")
    arguments = ("worker", "--data-dir", str(library.settings.data_dir), "--cluster", running.address)
    command = Command(arguments, log=tmp_path / "log")
    with ending(command):
        command.start()
        assert settled(library, shape_id).error_code is None
        command.stop()
    assert command.process is not None
    assert command.process.returncode == 0
    assert "Traceback" not in command.log.read_text()


def test_an_unreachable_scheduler_is_waited_for(caplog: pytest.LogCaptureFixture) -> None:
    nobody = Cluster(f"tcp://127.0.0.1:{free_port()}", limits=LIMITS)
    try:
        wait_until(lambda: any("no Dask scheduler answers" in line for line in caplog.messages))
        assert nobody.slots() == 0
        with pytest.raises(PoolStopped):
            nobody.submit(children.add, 1, 1).result()
    finally:
        nobody.shutdown(cancel_futures=True)


def test_a_cluster_of_another_release_is_given_no_job(
    running: Machines,
    cluster: Cluster,
    library: Library,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
) -> None:
    caplog.set_level("INFO")
    monkeypatch.setattr("service.jobs.cluster.release", lambda: "faience-9-0123456789abcdef")
    newer = Cluster(running.address, limits=LIMITS)
    try:
        wait_until(lambda: any("are of other releases" in line for line in caplog.messages))
        assert newer.slots() == 0
    finally:
        newer.shutdown(cancel_futures=True)


def test_a_machine_killed_in_mid_batch_costs_no_shape(
    running: Machines, library: Library, cluster: Cluster, gate: Gate
) -> None:
    ids = batch(library)
    with working(library, cluster, gate) as worker:
        wait_until(lambda: gate.tried() == SLOTS)
        running.computers[1].kill()
        gate.open()
        assert {settled(library, shape_id).status for shape_id in ids} == {Status.READY}
    assert worker.outcomes == ["ready"] * 6
