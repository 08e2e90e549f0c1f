"""A new version of the service starts on the library of an earlier one, over HTTP."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.fakes import coloured_triangle
from tests.problems import problem
from tests.serving import Serving, open_fake_library, serving, settings_for, wait_until
from tests.versions import NEW, REFUSED, accept, describe_newly, open_new_library, step, work_off

REDS = (10, 60, 110)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Make a library by the earlier version."""
    made = tmp_path_factory.mktemp("library")
    make_earlier(made)
    return made


def make_earlier(folder: Path) -> list[str]:
    """Make a library with one shape that the new version refuses; return the ids of the others."""
    library = open_fake_library(settings_for(folder))
    shapes = [accept(library, red) for red in REDS]
    accept(library, 200, REFUSED)
    work_off(library)
    library.close()
    return shapes


@pytest.fixture(scope="module")
def service(folder: Path) -> Iterator[Serving]:
    """Serve it by the new version, without a worker."""
    with serving(settings_for(folder, workers=0), describe_newly, open_new_library) as running:
        yield running


def search(service: Serving) -> Any:
    return service.client.post("/v1/search", files=[("files", ("a.ply", coloured_triangle(61)))])


def ids(service: Serving) -> dict[str, str]:
    listed = service.client.get("/v1/shapes").json()["items"]
    return {shape["name"]: shape["id"] for shape in listed}


def similar(service: Serving, name: str) -> dict[str, Any]:
    found: dict[str, Any] = service.client.get(f"/v1/shapes/{ids(service)[name]}/similar").json()
    return {**found, "took_ms": 0}


def renewal(service: Serving) -> Any:
    return service.client.get("/v1/queue").json()["renewal"]


def test_the_change_is_seen_and_told_from_its_beginning_to_its_end(service: Serving) -> None:
    before = {name: similar(service, name) for name in ids(service)}
    assert renewal(service) is None
    assert "begins when a worker" in problem(search(service), 503, "descriptions_changing")
    for number in range(1, 5):
        assert step(service.library)
        told = renewal(service)
        assert (told["done"] + told["failed"], told["total"]) == (number, 4)
        assert {name: similar(service, name) for name in before} == before
        assert search(service).json()["partly"] == told
    metrics = service.client.get("/metrics").text
    assert 'faience_renewal_shapes{outcome="done"} 3.0' in metrics
    assert 'faience_renewal_shapes{outcome="failed"} 1.0' in metrics
    one, other = ids(service)["shape 10"], ids(service)["shape 60"]
    problem(service.client.get(f"/v1/shapes/{one}/why/{other}"), 503, "descriptions_changing")
    numbers = service.client.get(f"/v1/shapes/{one}/descriptors").json()
    assert numbers["fingerprint"] != NEW.fingerprint()
    assert not step(service.library)  # this ends it
    assert renewal(service) is None
    after = similar(service, "shape 10")
    assert after["partly"] is None
    assert {hit["shape"]["name"] for hit in after["results"]} == {"shape 60", "shape 110"}
    assert after != before["shape 10"]
    numbers = service.client.get(f"/v1/shapes/{one}/descriptors").json()
    assert numbers["fingerprint"] == NEW.fingerprint()
    refused = service.shape(ids(service)["shape 200"])
    assert (refused["status"], refused["error"]["code"]) == ("failed", "too_complex")
    for name in ("thumbnail.png", "preview.glb"):
        assert service.client.get(f"/v1/shapes/{one}/{name}").status_code == 200
        assert service.client.get(f"/v1/shapes/{refused['id']}/{name}").status_code == 200


def test_the_service_with_its_own_worker_does_it_by_itself(tmp_path: Path) -> None:
    shapes = make_earlier(tmp_path)
    with serving(settings_for(tmp_path, workers=1), describe_newly, open_new_library) as new:
        late = new.add({"a.ply": coloured_triangle(250)}).json()
        assert late["status"] == "ready"

        def fingerprints() -> set[str]:
            answers = (new.client.get(f"/v1/shapes/{i}/descriptors").json() for i in [*shapes, late["id"]])
            return {answer["fingerprint"] for answer in answers}

        wait_until(lambda: fingerprints() == {NEW.fingerprint()})
        found = new.client.get(f"/v1/shapes/{late['id']}/similar").json()["results"]
        assert {hit["shape"]["id"] for hit in found} == set(shapes)
