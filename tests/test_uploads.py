"""A body arrives whole and in time, or leaves nothing behind."""

import os
import re
import socket
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.fakes import coloured_triangle
from tests.problems import problem
from tests.serving import Serving, serving, settings_for, wait_until

HEAD = (
    "POST /v1/shapes HTTP/1.1\r\nHost: localhost\r\nContent-Type: multipart/form-data; boundary=b0\r\n"
    "Content-Length: {length}\r\nConnection: close\r\n\r\n"
)
PARTS = (
    b'--b0\r\nContent-Disposition: form-data; name="files"; filename="a.ply"\r\n\r\n'
    + coloured_triangle(91)
    + b'\r\n--b0\r\nContent-Disposition: form-data; name="files"; filename="b.txt"\r\n\r\nnotes\r\n'
)
BODY = PARTS + b"--b0--\r\n"


@pytest.fixture
def service(tmp_path: Path) -> Iterator[Serving]:
    settings = settings_for(tmp_path, workers=0, body_idle_seconds=0.5, body_seconds=3)
    with serving(settings) as running:
        yield running


def connect(service: Serving) -> socket.socket:
    url = service.client.base_url
    connection = socket.create_connection((url.host, url.port or 80))
    connection.settimeout(60)
    return connection


def send(service: Serving, body: bytes, length: int | None = None) -> str:
    """Send a body, perhaps announced longer than it is, and hang up; return what was answered."""
    with connect(service) as connection:
        connection.sendall(HEAD.format(length=len(body) if length is None else length).encode() + body)
        if length is not None and length > len(body):
            connection.shutdown(socket.SHUT_WR)
        return b"".join(iter(lambda: connection.recv(65536), b"")).decode()


def left(service: Serving) -> list[Path]:
    root = service.library.settings.data_dir
    folders = (root / "files", service.library.incoming.folder)
    found = [(parent, name) for folder in folders for parent, _, names in os.walk(folder) for name in names]
    return [Path(parent, name) for parent, name in found if name != ".lock"]  # walk bears folders that go


def test_the_whole_body_is_accepted(service: Serving) -> None:
    assert " 202 " in send(service, BODY).splitlines()[0]
    assert len(left(service)) == 2


def test_a_body_that_ends_before_its_closing_boundary_is_refused_and_can_be_sent_again(
    service: Serving,
) -> None:
    for length in (0, 1, 50, len(PARTS) // 2, len(PARTS) - 1, len(PARTS), len(PARTS) + 2):
        answer = send(service, BODY[:length])
        assert re.search(r'"code":"(incomplete_body|bad_multipart)"', answer), answer
        assert " 400 " in answer.splitlines()[0]
        assert left(service) == []
    assert " 202 " in send(service, BODY).splitlines()[0]


def test_a_connection_that_breaks_leaves_nothing(service: Serving) -> None:
    for length in (0, 100, len(PARTS), len(BODY) - 1):
        assert " 202 " not in send(service, BODY[:length], length=len(BODY))
        wait_until(lambda: left(service) == [])
    assert service.client.get("/v1/shapes").json()["items"] == []


def test_a_stalled_body_is_given_up_while_others_work(service: Serving) -> None:
    stalled = [connect(service) for _ in range(20)]
    for connection in stalled:
        connection.sendall(HEAD.format(length=len(BODY)).encode() + BODY[:100])
    assert service.add({"a.ply": coloured_triangle(92)}, wait=0).status_code == 202
    for connection in stalled:
        answer = connection.recv(65536)
        assert b" 408 " in answer.splitlines()[0]
        connection.close()
    assert len(left(service)) == 1


def test_a_body_that_trickles_for_too_long_is_given_up(service: Serving) -> None:
    stop = threading.Event()
    with connect(service) as connection:
        connection.sendall(HEAD.format(length=10_000_000).encode() + BODY[:100])

        def trickle() -> None:
            while not stop.wait(0.2):
                try:
                    connection.sendall(b"x")
                except OSError:
                    return

        feeder = threading.Thread(target=trickle)
        feeder.start()
        answer = connection.recv(65536)
        stop.set()
        feeder.join()
    assert b" 408 " in answer.splitlines()[0]
    assert left(service) == []


def test_an_upload_that_would_eat_the_reserve_is_refused_and_reads_go_on(tmp_path: Path) -> None:
    with serving(settings_for(tmp_path, workers=0, reserve_bytes=2**60)) as running:
        problem(running.add({"a.ply": coloured_triangle()}, wait=0), 507, "storage_full")
        assert running.client.get("/v1/shapes").status_code == 200
        assert left(running) == []


def test_a_disk_that_fills_up_during_an_upload_is_told_and_recovers(
    service: Serving, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as broken:
        broken.setattr("service.intake.multipart._FilePart.add", full)
        problem(service.add({"a.ply": coloured_triangle()}, wait=0), 507, "storage_full")
    assert left(service) == []
    assert service.add({"a.ply": coloured_triangle()}, wait=0).status_code == 202
