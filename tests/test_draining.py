"""A server that is told to end says so, answers what is under way, and ends in its time."""

import contextlib
import signal
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import httpx
import pytest
from sse_starlette.sse import AppStatus

from index.shapes import Page
from service.commands.explaining import explain
from service.settings import Settings
from tests.fakes import coloured_triangle
from tests.problems import problem
from tests.serving import PATIENCE, Serving, serving, settings_for, wait_until


@pytest.fixture(autouse=True)
def restored(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let no later test hear of these ends: streams of events remember them for the whole process."""
    monkeypatch.setattr(AppStatus, "should_exit", False)


def told_to_end(running: Serving) -> None:
    running.server.handle_exit(signal.SIGTERM, None)  # what the signal would call


def listening(running: Serving) -> bool:
    with contextlib.suppress(httpx.ConnectError):
        return httpx.get(f"{running.client.base_url}/livez").is_success
    return False


def test_a_request_under_way_is_answered(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with serving(settings_for(tmp_path, workers=0)) as running, ThreadPoolExecutor(1) as threads:
        begun, go = threading.Event(), threading.Event()

        def slow(**_: object) -> Page:
            begun.set()
            go.wait(PATIENCE)
            return Page(items=(), next_cursor=None)

        monkeypatch.setattr(running.library.catalogue, "list", slow)
        answer = threads.submit(running.client.get, "/v1/shapes")
        begun.wait(PATIENCE)
        told_to_end(running)
        wait_until(lambda: not listening(running))  # it is on its way to the end
        go.set()
        assert answer.result().status_code == 200


def test_a_draining_service_is_not_ready_and_serves_until_a_second_signal(tmp_path: Path) -> None:
    with serving(settings_for(tmp_path, workers=0), drain_seconds=3600) as running:
        told_to_end(running)
        problem(running.client.get("/readyz"), 503, "shutting_down")  # at once
        assert running.client.get("/livez").status_code == 200
        assert httpx.get(f"{running.client.base_url}/v1/shapes").status_code == 200  # a new connection, too
        told_to_end(running)
        wait_until(lambda: not listening(running))


def test_a_draining_service_ends_by_itself(tmp_path: Path) -> None:
    with serving(settings_for(tmp_path, workers=0), drain_seconds=0.2) as running:
        told_to_end(running)
        wait_until(lambda: not listening(running))


def test_a_draining_service_begins_no_job(tmp_path: Path) -> None:
    with serving(settings_for(tmp_path, drain_seconds=3600), drain_seconds=3600) as running:
        told_to_end(running)
        wait_until(lambda: not any(thread.name == "worker" for thread in threading.enumerate()))
        added = running.add({"a.ply": coloured_triangle()}, wait=0)
        assert added.status_code == 202
        assert running.library.queue.depth() == 1


@pytest.mark.parametrize("words", ["-1", "soon"])
def test_a_time_that_is_none_is_refused_in_words(
    words: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("FAIENCE_DRAIN_SECONDS", words)
    with pytest.raises(ValueError, match="drain_seconds") as raised:
        Settings(data_dir=tmp_path)
    assert "the setting drain_seconds is refused" in str(explain(raised.value))
