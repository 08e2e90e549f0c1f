"""What was not answered is asked again; what was carried out unseen is not done twice."""

from collections.abc import Callable, Iterator
from pathlib import Path

import httpx2
import pytest

from faience_client import Changed, Faience, NotReached, Refused
from faience_client.connection import Connection
from soak.processes import free_port
from tests.fakes import coloured_triangle
from tests.losing import losing
from tests.serving import Serving, serving, settings_for

Answer = Callable[[httpx2.Request], httpx2.Response]


@pytest.fixture
def service(tmp_path: Path) -> Iterator[Serving]:
    with serving(settings_for(tmp_path)) as running:
        yield running


def connection(
    answer: Answer, monkeypatch: pytest.MonkeyPatch, patience: float = 60
) -> tuple[Connection, list[float]]:
    """Return a connection to a made service, and the pauses that it takes."""
    pauses: list[float] = []
    monkeypatch.setattr("time.sleep", pauses.append)
    made = Connection("http://there", None, patience)
    made._http = httpx2.Client(base_url="http://there", transport=httpx2.MockTransport(answer))
    return made, pauses


def test_an_upload_whose_answer_was_lost_is_kept_once(service: Serving) -> None:
    with losing(service.address, lost=2) as between, Faience(between.url) as faience:
        shape = faience.add(("m.ply", coloured_triangle()), wait=60)
        assert between.left == 0
        assert [one.id for one in faience.shapes()] == [shape.id]


def test_a_removal_whose_answer_was_lost_is_done(service: Serving) -> None:
    shape_id = service.add({"m.ply": coloured_triangle()}).json()["id"]
    with losing(service.address) as between, Faience(between.url) as faience:
        faience.remove(shape_id)
        with pytest.raises(Refused):
            faience.remove(shape_id)  # this time nobody lost an answer


def test_a_stream_that_was_cut_goes_on_where_it_was(service: Serving) -> None:
    with losing(service.address) as between, Faience(between.url) as faience:
        changes = faience.watch(since=0)
        shape_id = service.add({"m.ply": coloured_triangle()}).json()["id"]
        told = next(changes)
        assert between.left == 0
        assert isinstance(told, Changed)
        assert told.shape.id == shape_id


def test_a_busy_service_is_asked_again_when_it_says(monkeypatch: pytest.MonkeyPatch) -> None:
    answers = iter(
        [
            httpx2.Response(503, headers={"Retry-After": "7"}),
            httpx2.Response(429),
            httpx2.Response(200, json=1),
        ]
    )
    made, pauses = connection(lambda _: next(answers), monkeypatch)
    assert made.ask("/") == 1
    assert pauses[0] == 7
    assert 0 < pauses[1] < 1


def test_pauses_grow_and_end_with_patience(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = [0.0]
    made, pauses = connection(lambda _: httpx2.Response(502, text="<p>a proxy</p>"), monkeypatch, patience=30)
    monkeypatch.setattr("time.monotonic", lambda: clock[0])

    def sleep(seconds: float) -> None:
        pauses.append(seconds)
        clock[0] += seconds

    monkeypatch.setattr("time.sleep", sleep)
    with pytest.raises(NotReached, match="a proxy"):
        made.ask("/")
    assert 20 < sum(pauses) <= 30
    assert max(pauses) > 10 * min(pauses)


def test_who_is_not_there_is_named() -> None:
    with (
        Faience(f"http://127.0.0.1:{free_port()}", patience=0.5) as faience,
        pytest.raises(NotReached, match="ConnectError"),
    ):
        faience.counts()


def test_a_refusal_is_not_asked_again(monkeypatch: pytest.MonkeyPatch) -> None:
    made, pauses = connection(
        lambda _: httpx2.Response(507, json={"code": "storage_full", "title": "Full", "detail": "x"}),
        monkeypatch,
    )
    with pytest.raises(Refused, match="storage_full"):
        made.ask("/")
    assert pauses == []


def test_a_file_is_sent_from_its_beginning_each_time(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    bodies: list[bytes] = []

    def answer(request: httpx2.Request) -> httpx2.Response:
        bodies.append(request.read())
        return httpx2.Response(503) if len(bodies) < 3 else httpx2.Response(404, json={})

    mesh = tmp_path / "m.ply"
    mesh.write_bytes(coloured_triangle())
    faience = Faience("http://there")
    faience._service, _ = connection(answer, monkeypatch)
    with pytest.raises(Refused):
        faience.add(mesh)
    assert len(bodies) == 3
    assert all(coloured_triangle() in body for body in bodies)


def test_a_key_is_sent() -> None:
    with Faience("http://127.0.0.1:1", key="secret") as faience:
        assert faience._service._http.headers["authorization"] == "Bearer secret"
