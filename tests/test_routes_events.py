"""What changes is told as it happens."""

import json
from collections.abc import Iterator
from typing import Any

import httpx
import pytest

from tests.fakes import coloured_triangle
from tests.problems import problem
from tests.serving import Serving, serving, settings_for

pytestmark = pytest.mark.usefixtures("database")  # on SQLite and on PostgreSQL


@pytest.fixture
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Serving]:
    with serving(settings_for(tmp_path_factory.mktemp("library"))) as running:
        yield running


def events(stream: httpx.Response) -> Iterator[dict[str, Any]]:
    """Yield the events of a stream."""
    event: dict[str, Any] = {}
    for line in stream.iter_lines():
        if not line:
            if "data" in event:
                yield event
            event = {}
        elif not line.startswith(":"):
            name, _, value = line.partition(": ")
            event[name] = json.loads(value) if name == "data" else value


def test_a_shape_is_told_until_it_is_ready_and_when_it_is_removed(service: Serving) -> None:
    with service.client.stream("GET", "/v1/events") as stream:
        assert stream.headers["content-type"].startswith("text/event-stream")
        told = events(stream)
        shape_id = service.add({"a.ply": coloured_triangle()}, wait=0).json()["id"]
        states = []
        for event in told:
            assert (event["event"], event["data"]["id"]) == ("shape", shape_id)
            states.append(event["data"]["status"])
            if states[-1] == "ready":
                break
        assert set(states) <= {"queued", "processing", "ready"}
        service.client.delete(f"/v1/shapes/{shape_id}")
        removed = next(told)
        assert (removed["event"], removed["data"]) == ("removed", {"id": shape_id})


def test_a_client_that_was_cut_off_gets_what_it_missed(service: Serving) -> None:
    first = service.add({"a.ply": coloured_triangle(1)}).json()["id"]
    with service.client.stream("GET", "/v1/events", params={"since": 0}) as stream:
        told = next(events(stream))
        assert told["data"]["id"] == first
        last = told["id"]
    second = service.add({"b.ply": coloured_triangle(2)}).json()["id"]
    with service.client.stream("GET", "/v1/events", headers={"last-event-id": last}) as stream:
        assert next(events(stream))["data"]["id"] == second


@pytest.mark.parametrize("last", ["9" * 5000, "-1", "x", "٣"])
def test_an_event_id_that_is_none_of_ours_starts_from_now(service: Serving, last: str) -> None:
    with service.client.stream("GET", "/v1/events", headers=[(b"last-event-id", last.encode())]) as stream:
        assert stream.status_code == 200


def test_a_revision_beyond_all_is_refused(service: Serving) -> None:
    problem(service.client.get("/v1/events", params={"since": "9" * 20}), 422, "invalid_request")
