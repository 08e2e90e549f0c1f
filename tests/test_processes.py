"""Every process of a service is found, whoever started it, and ended with it."""

import subprocess
import sys
from pathlib import Path

import pytest

from soak.processes import Command, alive, descendants, ending, free_port, kill, serve, start, wait_until

SLEEP = "import time; time.sleep(600)"
FAMILY = f"""
import subprocess, sys, threading, time
def start(): children.append(subprocess.Popen([sys.executable, "-c", {SLEEP!r}]))
children = []
start()
other = threading.Thread(target=lambda: (start(), time.sleep(600)))
other.start()
"""


def test_children_of_every_thread_are_found() -> None:
    with subprocess.Popen([sys.executable, "-c", FAMILY]) as parent:
        wait_until(lambda: len(descendants(parent.pid)) == 2)
        family = descendants(parent.pid)
        assert all(map(alive, family))
        parent.kill()
        parent.wait()
        assert all(map(kill, family))
        wait_until(lambda: not any(map(alive, family)))


def test_what_has_ended_is_not_alive_and_cannot_be_killed() -> None:
    with subprocess.Popen([sys.executable, "-c", "pass"]) as done:
        done.wait()
    assert not alive(done.pid)
    assert not kill(done.pid)
    assert descendants(done.pid) == []


def test_a_killed_service_takes_its_children_along_and_starts_again(tmp_path: Path) -> None:
    port = free_port()
    service = serve(tmp_path / "library", port, 1, {})
    with ending(service):
        start(service, port)
        wait_until(lambda: len(service.family()) > 0)  # the fork server, at least
        family = service.family()
        service.kill()
        assert not any(map(alive, family))
        start(service, port)
        service.stop()
        assert not service.running()


def test_a_service_that_ends_at_once_is_told(tmp_path: Path) -> None:
    service = Command(("serve", "--port", "no number"), log=tmp_path / "log")
    with pytest.raises(RuntimeError, match="ended at its start"):
        start(service, free_port())
    assert "--port" in (tmp_path / "log").read_text()
