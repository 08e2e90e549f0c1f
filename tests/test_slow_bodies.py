"""Whatever the call, a body comes in time or its sender is told; answers take as long as they need."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from soak.wire import connected, exchange, read_reply
from tests.fakes import coloured_triangle
from tests.serving import Serving, serving, settings_for

CHANGE = (
    b"PATCH /v1/shapes/%s HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
    b'Content-Length: 99\r\n\r\n{"name"'
)
LISTEN = b"GET /v1/events?since=0 HTTP/1.1\r\nHost: localhost\r\nContent-Length: 99\r\n\r\n{"


@pytest.fixture
def service(tmp_path: Path) -> Iterator[Serving]:
    with serving(settings_for(tmp_path, workers=0, body_idle_seconds=1, body_seconds=5)) as running:
        yield running


def test_json_that_does_not_end_is_given_up(service: Serving) -> None:
    shape = service.add({"a.ply": coloured_triangle()}, wait=0).json()
    reply = exchange(service.address, CHANGE % shape["id"].encode())
    assert (reply.status, reply.code) == (408, "slow_body")
    assert "7 bytes" in reply.json()["detail"]
    assert service.shape(shape["id"]) == shape


def test_a_body_that_nobody_reads_ends_no_answer(service: Serving) -> None:
    with connected(service.address) as connection:
        connection.sendall(LISTEN)
        assert read_reply(connection).status == 200
        shape = service.add({"a.ply": coloured_triangle()}, wait=3).json()  # longer than a body may rest
        told = b""
        while shape["id"].encode() not in told:
            told += connection.recv(65536)
