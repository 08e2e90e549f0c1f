"""HEAD gives the head that GET gives, and nothing after it."""

from collections.abc import Iterator

import pytest

from soak.wire import connected, exchange, read_reply
from tests.fakes import coloured_triangle
from tests.serving import Serving, serving, settings_for


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Serving]:
    with serving(settings_for(tmp_path_factory.mktemp("library"), workers=1)) as running:
        yield running


@pytest.fixture(scope="module")
def shape_id(service: Serving) -> str:
    return str(service.add({"a.ply": coloured_triangle()}).json()["id"])


@pytest.mark.parametrize(
    "path",
    [
        "/livez",
        "/",
        "/v1/shapes/{}",
        "/v1/shapes/{}/files/a.ply",
        "/v1/shapes/{}/thumbnail.png",
        "/v1/shapes/x",
    ],
)
def test_the_head_is_the_same(service: Serving, shape_id: str, path: str) -> None:
    path = path.format(shape_id)
    same = {"X-Request-ID": "the-same"}
    whole, head = service.client.get(path, headers=same), service.client.head(path, headers=same)
    assert (head.status_code, head.content) == (whole.status_code, b"")
    for answer in (whole, head):
        answer.headers.pop("date")
    assert head.headers == whole.headers


def test_the_connection_serves_the_next_request(service: Serving, shape_id: str) -> None:
    lines = f"{{}} /v1/shapes/{shape_id}/files/a.ply HTTP/1.1\r\nHost: localhost\r\n\r\n"
    with connected(service.address) as connection:
        connection.sendall(lines.format("HEAD").encode())
        assert read_reply(connection, bodiless=True).body == b""
        connection.sendall(lines.format("GET").encode())
        assert read_reply(connection).body == coloured_triangle()


def test_the_head_of_an_endless_answer_ends(service: Serving) -> None:
    lines = b"HEAD /v1/events HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n"
    with connected(service.address) as connection:
        connection.sendall(lines)
        data = b"".join(iter(lambda: connection.recv(65536), b""))
    assert data.startswith(b"HTTP/1.1 200 OK\r\n")
    assert data.endswith(b"\r\n\r\n")
    assert b"text/event-stream" in data


def test_a_head_needs_what_a_get_needs(service: Serving) -> None:
    foreign = b"HEAD /v1/shapes HTTP/1.1\r\nHost: elsewhere.example\r\n\r\n"
    assert exchange(service.address, foreign).status == 403


def test_it_is_counted_as_what_it_is(service: Serving) -> None:
    assert service.client.head("/readyz").status_code == 200
    counted = 'faience_requests_total{method="HEAD",path="/readyz",status="200"} 1.0'
    assert counted in service.client.get("/metrics").text
