"""An empty library is filled once, and shows what a search finds."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from service.first_run import show_samples
from service.samples import Sample
from tests.fakes import coloured_triangle
from tests.serving import Serving, serving, settings_for

SAMPLES = [
    Sample(name=f"cat {level}", files={"a.ply": coloured_triangle(level)}, metadata={"creature": "cat"})
    for level in (10, 40, 200)
]


@pytest.fixture
def service(tmp_path: Path) -> Iterator[Serving]:
    with serving(settings_for(tmp_path)) as running:
        yield running


def test_samples_are_indexed_and_one_ranked_answer_is_told(service: Serving) -> None:
    told: list[str] = []
    show_samples(service.library, SAMPLES, len(SAMPLES), lambda: False, told.append)
    assert "cat 10" in told[1]
    assert [line.split()[-1] for line in told[2:]] == ["40", "200"]
    items = service.client.get("/v1/shapes").json()["items"]
    assert {(shape["name"], shape["metadata"]["creature"]) for shape in items} == {
        (sample.name, "cat") for sample in SAMPLES
    }


def test_a_later_run_adds_nothing_and_tells_the_answer_again(service: Serving) -> None:
    first: list[str] = []
    later: list[str] = []
    show_samples(service.library, SAMPLES, len(SAMPLES), lambda: False, first.append)
    show_samples(service.library, SAMPLES, len(SAMPLES), lambda: False, later.append)
    assert [line.split()[1:] for line in later[1:]] == [line.split()[1:] for line in first[2:]]
    assert len(service.client.get("/v1/shapes").json()["items"]) == len(SAMPLES)


def test_a_run_that_was_stopped_is_completed_by_the_next(service: Serving) -> None:
    show_samples(service.library, SAMPLES[:1], len(SAMPLES), lambda: False, lambda _: None)
    show_samples(service.library, SAMPLES, len(SAMPLES), lambda: False, lambda _: None)
    assert len(service.client.get("/v1/shapes").json()["items"]) == len(SAMPLES)


def test_a_library_that_holds_something_is_left_alone(service: Serving) -> None:
    service.add({"own.ply": coloured_triangle(5)})
    told: list[str] = []
    show_samples(service.library, SAMPLES, len(SAMPLES), lambda: False, told.append)
    assert told == []
    assert len(service.client.get("/v1/shapes").json()["items"]) == 1


def test_waiting_ends_when_the_service_does(tmp_path: Path) -> None:
    told: list[str] = []
    with serving(settings_for(tmp_path, workers=0)) as idle:
        show_samples(idle.library, SAMPLES, len(SAMPLES), lambda: True, told.append)
    assert len(told) == 1
