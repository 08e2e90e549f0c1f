"""The library at a glance, over HTTP."""

from collections.abc import Iterator

import pytest

from tests.fakes import coloured_triangle
from tests.problems import problem
from tests.serving import Serving, serving, settings_for


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Serving]:
    with serving(settings_for(tmp_path_factory.mktemp("library"), workers=1)) as running:
        for red, tags in ((10, '["vase", "old"]'), (60, '["Vase"]')):
            running.add({"a.ply": coloured_triangle(red)}, name=f"red {red}", metadata=f'{{"tags": {tags}}}')
        running.add({"crash.ply": coloured_triangle(200)}, name="odd")
        yield running


def test_tags_are_listed_with_their_numbers(service: Serving) -> None:
    answer = service.client.get("/v1/tags").json()
    assert answer == {
        "items": [{"tag": "Vase", "shapes": 2}, {"tag": "old", "shapes": 1}],
        "next_cursor": None,
    }
    assert service.client.get("/v1/tags", params={"q": "o"}).json()["items"] == [{"tag": "old", "shapes": 1}]
    problem(service.client.get("/v1/tags", params={"cursor": "x"}), 422, "bad_cursor")


def names(service: Serving, tag: str | list[str]) -> list[str]:
    listed = service.client.get("/v1/shapes", params={"tag": tag}).json()["items"]
    return [shape["name"] for shape in listed]


def test_shapes_are_listed_by_tag(service: Serving) -> None:
    assert names(service, tag="vase") == ["red 60", "red 10"]
    assert names(service, tag=["vase", "old"]) == ["red 10"]
    assert names(service, tag="urn") == []


def test_counts_add_up(service: Serving) -> None:
    counts = service.client.get("/v1/counts").json()
    assert counts == {"total": 3, "queued": 0, "processing": 0, "ready": 2, "failed": 1}
    assert service.client.get("/v1/counts", params={"tag": "old"}).json()["total"] == 1
    assert service.client.get("/v1/counts", params={"q": "RED"}).json()["ready"] == 2


def test_the_queue_tells_its_speed(service: Serving) -> None:
    queue = service.client.get("/v1/queue").json()
    assert (queue["queued"], queue["processing"], queue["failed"]) == (0, 0, 1)
    assert queue["finished"]["last_hour"] >= 2
    assert queue["median_seconds"] > 0
    assert queue["expected_seconds"] == 0
    assert queue["workers"] == []
