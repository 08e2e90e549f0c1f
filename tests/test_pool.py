"""One job can only harm itself."""

import os
import subprocess
import sys
import time
from collections.abc import Iterator
from concurrent.futures import Executor
from pathlib import Path

import pytest

from service.jobs.child import ChildError, ChildLimits
from service.jobs.pool import ChildDied, PoolStopped, ProcessPerJob
from tests import children
from worker.errors import Code, MeshError

LIMITS = ChildLimits(memory_bytes=2 * 2**30, cpu_seconds=60, wall_seconds=120)
TIGHT = ChildLimits(memory_bytes=2**30, cpu_seconds=1, wall_seconds=120)
IMPATIENT = ChildLimits(memory_bytes=2**30, cpu_seconds=60, wall_seconds=0.3)
HERE = Path(__file__).parent
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(HERE.parent)}


@pytest.fixture
def pool() -> Iterator[ProcessPerJob]:
    made = ProcessPerJob(slots=2, limits=LIMITS)
    yield made
    made.shutdown(cancel_futures=True)


@pytest.fixture
def tight() -> Iterator[ProcessPerJob]:
    made = ProcessPerJob(slots=2, limits=TIGHT)
    yield made
    made.shutdown(cancel_futures=True)


def alive(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except FileNotFoundError:
        return False


def ends(pid: int) -> bool:
    """Wait for a process to end; the bound is only for a test that would fail."""
    deadline = time.monotonic() + 60
    while alive(pid) and time.monotonic() < deadline:
        time.sleep(0.02)
    return not alive(pid)


def test_a_value_comes_back(pool: Executor) -> None:
    assert pool.submit(children.add, 2, 3).result() == 5


def test_every_job_has_its_own_process(pool: Executor) -> None:
    pids = {pool.submit(children.identify).result() for _ in range(3)}
    assert len(pids) == 3
    assert os.getpid() not in pids


def test_a_large_answer_comes_back_whole(pool: Executor) -> None:
    assert len(pool.submit(children.return_much, 30_000_000).result()) == 30_000_000


def test_a_refusal_keeps_its_code(pool: Executor) -> None:
    with pytest.raises(MeshError) as caught:
        pool.submit(children.refuse).result()
    assert (caught.value.code, caught.value.detail) == (Code.NO_FACES, "points only")


def test_a_defect_is_told_from_a_refusal(pool: Executor) -> None:
    with pytest.raises(ChildError, match="KeyError"):
        pool.submit(children.have_a_defect).result()


def test_a_crash_costs_its_own_job_alone(pool: Executor) -> None:
    crash = pool.submit(children.exit_at_once, 3)
    others = [pool.submit(children.add, number, 1) for number in range(4)]
    assert [other.result() for other in others] == [1, 2, 3, 4]
    with pytest.raises(ChildDied) as caught:
        crash.result()
    assert caught.value.exit_code == 3


def test_a_killed_process_costs_its_own_job_alone(pool: Executor) -> None:
    with pytest.raises(ChildDied) as caught:
        pool.submit(children.kill_itself).result()
    assert caught.value.exit_code == -9
    assert pool.submit(children.add, 1, 1).result() == 2


def test_a_hanging_process_is_ended_at_its_wall_limit() -> None:
    pool = ProcessPerJob(slots=1, limits=IMPATIENT)
    try:
        with pytest.raises(MeshError) as caught:
            pool.submit(children.hang).result()
        assert caught.value.code == Code.TOO_COMPLEX
    finally:
        pool.shutdown(cancel_futures=True)


def test_processor_time_is_limited(tight: Executor) -> None:
    with pytest.raises(MeshError, match="processor time") as caught:
        tight.submit(children.spin).result()
    assert caught.value.code == Code.TOO_COMPLEX


def test_memory_is_limited(pool: Executor) -> None:
    with pytest.raises(MeshError, match="2048 MiB") as caught:
        pool.submit(children.eat_memory).result()
    assert caught.value.code == Code.TOO_COMPLEX
    assert pool.submit(children.add, 1, 1).result() == 2


def test_a_stopped_pool_kills_what_runs_and_says_so(tmp_path: Path) -> None:
    pool = ProcessPerJob(slots=1, limits=LIMITS)
    mark = tmp_path / "pid"
    running = pool.submit(children.write_identity_and_hang, mark)
    while not mark.exists():
        time.sleep(0.01)
    pool.shutdown(cancel_futures=True)
    with pytest.raises(PoolStopped):
        running.result()
    assert ends(int(mark.read_text()))


def test_children_compute_with_one_thread_whatever_the_service_does() -> None:
    script = (
        "from tests import children, test_pool\n"
        "from service.jobs.pool import ProcessPerJob\n"
        "pool = ProcessPerJob(slots=1, limits=test_pool.LIMITS)\n"
        "print(pool.submit(children.threads_of_numpy).result())\n"
    )
    plain = {name: value for name, value in ENVIRONMENT.items() if "NUM_THREADS" not in name}
    done = subprocess.run(
        [sys.executable, "-c", script], env=plain, check=True, capture_output=True, text=True
    )
    assert done.stdout.strip() == "{1}"


def test_a_child_ends_when_its_service_is_killed(tmp_path: Path) -> None:
    mark = tmp_path / "pid"
    script = (
        "import pathlib\n"
        "from tests import children, test_pool\n"
        "from service.jobs.pool import ProcessPerJob\n"
        "pool = ProcessPerJob(slots=1, limits=test_pool.LIMITS)\n"
        f"pool.submit(children.write_identity_and_hang, pathlib.Path({str(mark)!r})).result()\n"
    )
    service = subprocess.Popen([sys.executable, "-c", script], env=ENVIRONMENT)
    while not mark.exists() and service.poll() is None:
        time.sleep(0.01)
    service.kill()
    service.wait()
    assert ends(int(mark.read_text()))


def test_a_command_is_not_imported_again_by_every_child(tmp_path: Path) -> None:
    log, script = tmp_path / "log", tmp_path / "command.py"
    script.write_text(
        "import sys\n"
        "open(sys.argv[1], 'a').write('imported ')\n"
        "from tests import children, test_pool\n"
        "from service.jobs.pool import ProcessPerJob\n"
        "if __name__ == '__main__':\n"
        "    pool = ProcessPerJob(slots=1, limits=test_pool.LIMITS)\n"
        "    for _ in range(2): pool.submit(children.identify).result()\n"
    )
    subprocess.run([sys.executable, script, log], check=True, env=ENVIRONMENT)
    assert log.read_text().split() == ["imported"]
