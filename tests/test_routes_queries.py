"""A mesh that is not kept is asked about again, without being sent again."""

from collections.abc import Iterator
from typing import Any

import pytest

from service.jobs.describing import describe_files
from tests.problems import problem
from tests.serving import Serving, serving, settings_for
from tests.small_library import good_mesh, open_small_library

NOBODY = "0" * 32


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Serving]:
    settings = settings_for(tmp_path_factory.mktemp("library"))
    with serving(settings, describe=describe_files, open_library=open_small_library) as running:
        for number in range(4):
            running.add(good_mesh(number), name=f"block {number}")
        yield running


def search(service: Serving, number: int, **asked: Any) -> dict[str, Any]:
    parts = [("files", (name, content)) for name, content in good_mesh(number).items()]
    answer = service.client.post("/v1/search", params=asked, files=parts)
    assert answer.status_code == 200, answer.text
    found: dict[str, Any] = answer.json()
    return found


@pytest.fixture(scope="module")
def query_id(service: Serving) -> str:
    return str(search(service, 1, remember=True)["query"]["id"])


def results(answer: dict[str, Any]) -> list[tuple[str, float]]:
    return [(result["shape"]["id"], result["distance"]) for result in answer["results"]]


def test_nothing_is_remembered_that_was_not_to_be(service: Serving) -> None:
    before = set(service.library.files.keys("queries"))
    query = search(service, 2)["query"]
    assert (query["id"], query["name"]) == (None, "good")
    assert set(service.library.files.keys("queries")) == before


@pytest.mark.parametrize(
    "asked",
    [
        {},
        {"relations": True},
        {"method": "chks", "limit": 2},
        {"method": "hks"},
        {"weights": "log-hks:0,colour-histogram:1"},
    ],
)
def test_it_is_answered_as_the_mesh_itself(service: Serving, query_id: str, asked: dict[str, Any]) -> None:
    again = service.client.get(f"/v1/queries/{query_id}/similar", params=asked).json()
    first = search(service, 1, **asked)
    assert results(again) == results(first)
    told = [[result["relation"] for result in answer["results"]] for answer in (again, first)]
    assert told[0] == told[1]
    assert again["query"] == {**first["query"], "id": query_id}


def test_the_mesh_itself_is_the_nearest_and_the_same_file(service: Serving, query_id: str) -> None:
    asked = {"relations": True}
    nearest = service.client.get(f"/v1/queries/{query_id}/similar", params=asked).json()["results"][0]
    assert nearest["shape"]["name"] == "block 1"
    assert nearest["relation"]["name"] == "same_file"


def test_it_can_be_looked_at(service: Serving, query_id: str) -> None:
    picture = service.client.get(f"/v1/queries/{query_id}/thumbnail.png", params={"width": 96})
    assert picture.headers["content-type"] == "image/png"
    assert picture.content.startswith(b"\x89PNG")
    mesh = service.client.get(f"/v1/queries/{query_id}/preview.glb")
    assert mesh.headers["content-type"] == "model/gltf-binary"
    assert mesh.content.startswith(b"glTF")
    told = service.client.get(f"/v1/queries/{query_id}").json()
    assert (told["id"], told["name"], told["mesh"]["faces"]) == (query_id, "good", 12)
    assert told["expires_at"].endswith(("Z", "+00:00"))


@pytest.mark.parametrize("part", ["", "/similar", "/thumbnail.png", "/preview.glb"])
@pytest.mark.parametrize("odd", [NOBODY, "x", "%2e%2e", "%00"])
def test_what_is_not_remembered_is_told_in_words(service: Serving, odd: str, part: str) -> None:
    answer = service.client.get(f"/v1/queries/{odd}{part}")
    problem(answer, 404, "query_not_found" if odd[0] != "%" else answer.json()["code"])


def test_a_question_is_checked_as_any_other(service: Serving, query_id: str) -> None:
    similar = f"/v1/queries/{query_id}/similar"
    problem(service.client.get(similar, params={"method": "none"}), 422, "unknown_method")
    problem(service.client.get(similar, params={"weights": "none:1"}), 422, "bad_weights")


def test_it_outlives_a_restart_and_is_no_shape(service: Serving, query_id: str) -> None:
    settings = service.library.settings.model_copy(update={"workers": 0})
    with serving(settings, describe=describe_files, open_library=open_small_library) as other:
        assert other.client.get(f"/v1/queries/{query_id}/similar").status_code == 200
        assert other.client.get("/v1/counts").json()["total"] == 4
        problem(other.client.get(f"/v1/shapes/{query_id}"), 404, "not_found")
