"""A connection that says nothing, or does not listen, or speaks no HTTP, costs little and not for long."""

import socket
import struct
import time
from collections.abc import Iterator

import pytest

from service.http.connections import BoundedConnection
from soak.wire import connected, exchange, read_reply
from tests.serving import Serving, serving, settings_for, wait_until

HEAD = b"GET /livez HTTP/1.1\r\nHost: localhost\r\n"
GONE_AT_ONCE = struct.pack("ii", 1, 0)  # closed with a reset, not a farewell
CUT = (ConnectionResetError, BrokenPipeError)  # as the moment has it


class Hasty(BoundedConnection):
    """The same with little patience."""

    head_seconds = 1.5
    deaf_seconds = 1.0
    linger_seconds = 5.0
    most = 30


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Serving]:
    folder = tmp_path_factory.mktemp("library")
    with serving(settings_for(folder, workers=0), connection=Hasty) as running:
        yield running


@pytest.mark.parametrize("begun", [b"G", b"GET /livez HTTP/1.1\r\n", HEAD])
def test_a_head_that_does_not_end_is_told_and_the_connection_closed(service: Serving, begun: bytes) -> None:
    reply = exchange(service.address, begun)
    assert (reply.status, reply.code) == (408, "slow_request")
    assert reply.headers["connection"] == "close"


def test_a_head_that_trickles_has_no_more_time(service: Serving) -> None:
    with connected(service.address) as connection:
        connection.sendall(HEAD)
        connection.settimeout(0.1)
        start = time.monotonic()
        while True:
            try:
                connection.sendall(b"X: y\r\n")
                assert connection.recv(9) == b"HTTP/1.1 "
                break
            except TimeoutError:
                assert time.monotonic() - start < 60
        connection.settimeout(60)
        assert connection.recv(3) == b"408"


def test_a_connection_that_says_nothing_is_closed_without_a_word(service: Serving) -> None:
    assert exchange(service.address, b"").status is None


def test_a_second_head_has_as_much_time_as_the_first(service: Serving) -> None:
    with connected(service.address) as connection:
        connection.sendall(HEAD + b"\r\n")
        assert read_reply(connection).status == 200
        connection.sendall(HEAD)
        assert read_reply(connection).status == 408


def send_for_ever(connection: socket.socket, words: bytes) -> None:
    while True:
        connection.sendall(words)


def test_a_body_after_its_answer_is_not_read_for_ever(service: Serving) -> None:
    with connected(service.address) as connection:
        connection.sendall(HEAD + b"Content-Length: 1000000000000\r\n\r\n")
        assert read_reply(connection).status == 200
        with pytest.raises(CUT):
            send_for_ever(connection, b"x" * 1000)


def test_a_client_that_never_reads_its_answers_is_cut_off(service: Serving) -> None:
    with connected(service.address) as connection:
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        with pytest.raises(CUT):  # the answers fill every buffer on their way, then nothing more is taken
            send_for_ever(connection, b"GET /openapi.json HTTP/1.1\r\nHost: localhost\r\n\r\n")


@pytest.mark.parametrize("words", [b"\x16\x03\x01\x00\xc8\r\n\r\n", b"GET /livez\r\n\r\n", b"a b c\r\n\r\n"])
def test_what_is_no_http_is_answered_by_a_problem(service: Serving, words: bytes) -> None:
    reply = exchange(service.address, words)
    assert (reply.status, reply.code) == (400, "bad_request")
    assert set(reply.json()) == {"type", "title", "status", "detail", "code"}


def test_a_head_without_measure_is_refused(service: Serving) -> None:
    reply = exchange(service.address, HEAD + b"X: " + b"y" * 2_000_000)
    assert (reply.status, reply.code) == (431, "headers_too_large")


def test_a_broken_body_is_told_to_the_client_and_to_whoever_reads_it(service: Serving) -> None:
    head = b"POST /v1/shapes HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n"
    kind = b"Content-Type: multipart/form-data; boundary=b0\r\n\r\n"
    reply = exchange(service.address, head + kind + b"5\r\n--b0\r\r\nnonsense\r\n")
    assert (reply.status, reply.code) == (400, "bad_request")


def test_idle_connections_give_way_to_those_that_ask(service: Serving) -> None:
    idle = [socket.create_connection((service.address.host, service.address.port)) for _ in range(200)]
    assert exchange(service.address, HEAD + b"\r\n").status == 200
    for connection in idle:
        connection.close()


def test_too_many_requests_at_work_are_told_to_come_back(service: Serving) -> None:
    listen = b"GET /v1/events HTTP/1.1\r\nHost: localhost\r\n\r\n"
    listeners = [
        socket.create_connection((service.address.host, service.address.port)) for _ in range(Hasty.most)
    ]
    for connection in listeners:
        connection.sendall(listen)
        assert connection.recv(12) == b"HTTP/1.1 200"
    reply = exchange(service.address, HEAD + b"\r\n")
    assert (reply.status, reply.code) == (503, "busy")
    assert reply.headers["retry-after"]
    for connection in listeners:
        connection.close()
    wait_until(lambda: exchange(service.address, HEAD + b"\r\n").status == 200)


def test_a_client_that_is_gone_when_it_is_refused_is_no_defect(
    service: Serving, caplog: pytest.LogCaptureFixture
) -> None:
    for _ in range(50):
        with connected(service.address) as connection:
            connection.sendall(HEAD + b"\r\nno HTTP\r\n\r\n")
            connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, GONE_AT_ONCE)
    wait_until(lambda: service.client.get("/livez").status_code == 200)  # none of them is kept
    assert not [record for record in caplog.records if record.exc_info]
