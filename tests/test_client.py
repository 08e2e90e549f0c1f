"""The client does what the interface does, in Python's own values."""

import inspect
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from pydantic import BaseModel

import faience_client
from faience_client import Changed, Faience, Refused, Relation, Removed, Status, models
from service.app import create_app
from service.http.schemas import ShapeModel
from service.settings import Settings
from tests.fakes import coloured_triangle
from tests.serving import Serving, serving, settings_for

CALLS = {
    "addShape": "add",
    "changeShape": "change",
    "countShapes": "counts",
    "dismissPair": "dismiss",
    "downloadFile": "download",
    "explainDistance": "why",
    "explainDistanceOfQuery": "why_query",
    "explainOnQuery": "why_surfaces",
    "explainOnResult": "why_surfaces",
    "explainQueryOnQuery": "why_query_surfaces",
    "explainQueryOnResult": "why_query_surfaces",
    "findSimilar": "similar",
    "findSimilarToQuery": "similar_to_query",
    "getDescriptors": "descriptors",
    "getPreview": "preview",
    "getQuery": "query",
    "getQueryPreview": "query_preview",
    "getQueryThumbnail": "query_thumbnail",
    "getQueue": "queue",
    "getShape": "shape",
    "getThumbnail": "thumbnail",
    "listDismissals": "dismissals",
    "listDuplicates": "duplicates",
    "listMethods": "methods",
    "listShapes": "shapes",
    "listTags": "tags",
    "live": "ready",  # who is ready lives
    "metrics": "metrics",
    "ready": "ready",
    "removeShape": "remove",
    "retryShape": "retry",
    "searchByMesh": "search",
    "undismissPair": "undismiss",
    "watchShapes": "watch",
}
NAMES = {  # ours → the interface's, where they differ by more than `Model`
    "Evidence": "RelationModel",
    "RememberedQuery": "RememberedModel",
}


@pytest.fixture(scope="module")
def interface() -> dict[str, Any]:
    return create_app(Settings()).openapi()


@pytest.fixture
def service(tmp_path: Path) -> Iterator[Serving]:
    with serving(settings_for(tmp_path)) as running:
        yield running


@pytest.fixture
def faience(service: Serving) -> Iterator[Faience]:
    with Faience(str(service.client.base_url)) as client:
        yield client


def test_every_call_of_the_interface_has_a_method(interface: dict[str, Any]) -> None:
    calls = {call["operationId"] for path in interface["paths"].values() for call in path.values()}
    assert calls == set(CALLS)
    public = {name for name, _ in inspect.getmembers(Faience, inspect.isfunction) if name[0] != "_"}
    assert public == {*CALLS.values(), "close", "settled"}


def test_every_value_has_the_fields_of_the_interface(interface: dict[str, Any]) -> None:
    ours = [
        each
        for _, each in inspect.getmembers(models, inspect.isclass)
        if issubclass(each, BaseModel) and each.__module__ == models.__name__ and each.__name__ != "_Model"
    ]
    schemas = interface["components"]["schemas"]
    assert len(ours) > 20
    for each in ours:
        theirs = schemas[NAMES.get(each.__name__, f"{each.__name__}Model")]
        assert set(each.model_fields) == set(theirs["properties"]), each
    assert [*Status] == schemas["Status"]["enum"]
    assert [*Relation] == schemas["Relation"]["enum"]


def test_what_a_later_service_adds_is_left_out() -> None:
    told = {**ShapeModel.model_config["json_schema_extra"]["example"], "votes": 7}  # type: ignore[index, dict-item]
    assert faience_client.Shape.model_validate(told).name == "amphora"


def test_a_shape_from_its_files_to_its_answer_and_away(faience: Faience, tmp_path: Path) -> None:
    for number in range(3):
        (tmp_path / f"m{number}.ply").write_bytes(coloured_triangle(number))
    shape = faience.add(tmp_path / "m0.ply", name="vase", metadata={"tags": ["clay"]}, wait=60)
    assert (shape.name, shape.status, shape.metadata) == ("vase", Status.READY, {"tags": ["clay"]})
    assert faience.add(tmp_path / "m0.ply").id == shape.id  # known
    other = faience.add(("m1.ply", coloured_triangle(1)), wait=60)
    assert [one.id for one in faience.shapes(q="vase")] == [shape.id]
    assert {one.id for one in faience.shapes(status=Status.READY)} == {shape.id, other.id}
    assert [(tag.tag, tag.shapes) for tag in faience.tags()] == [("clay", 1)]
    answer = faience.similar(shape.id, method="fused", weights={"log-hks": 0.0}, relations=True)
    assert [result.shape.id for result in answer.results] == [other.id]
    asked = faience.search(tmp_path / "m0.ply", remember=True, limit=1)
    assert asked.results[0].shape.id == shape.id
    assert asked.query is not None
    assert asked.query.id is not None
    assert faience.query(asked.query.id).name == "m0"
    assert faience.similar_to_query(asked.query.id, method="hks").method == "hks"
    assert faience.change(shape.id, name="jug").name == "jug"
    assert faience.download(shape.id, "m0.ply", tmp_path / "back.ply").read_bytes() == coloured_triangle(0)
    assert faience.thumbnail(shape.id).startswith(b"\x89PNG")
    assert faience.preview(shape.id).startswith(b"glTF")
    assert "hks" in {method.name for method in faience.methods()}
    assert faience.descriptors(shape.id).blocks
    faience.remove(shape.id)
    assert faience.counts().total == 1
    assert faience.queue().queued == 0
    assert faience.ready()
    assert "faience_shapes" in faience.metrics()


def test_a_refusal_has_its_code_and_words(faience: Faience) -> None:
    with pytest.raises(Refused, match="mesh") as told:
        faience.add(("m.ply", b"ply\nbroken"))
    assert (told.value.status, told.value.repeated) == (422, False)
    assert told.value.code in ("truncated", "bad_data", "bad_header")
    with pytest.raises(Refused) as told:
        faience.remove("nobody")
    assert told.value.code == "not_found"
    with pytest.raises(ValueError, match="at least one file"):
        faience.add()


def test_pairs_are_dismissed_and_taken_back(faience: Faience) -> None:
    one, other = (faience.add((f"m{n}.ply", coloured_triangle(n)), wait=60).id for n in range(2))
    assert {faience.dismiss(one, other).one, *[pair.other for pair in faience.dismissals()]} == {one, other}
    faience.undismiss(one, other)
    assert list(faience.dismissals()) == []


def test_more_shapes_than_a_page_are_all_told(
    service: Serving, faience: Faience, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("faience_client.shapes.PAGE", 2)
    ids = [service.add({f"m{n}.ply": coloured_triangle(n)}, wait=0).json()["id"] for n in range(5)]
    assert [shape.id for shape in faience.shapes()] == ids[::-1]


def test_changes_are_told_and_none_is_missed_when_the_connection_was_lost(faience: Faience) -> None:
    told: list[Changed | Removed] = []
    ended = threading.Event()

    def listen() -> None:
        for event in faience.watch(since=0):
            told.append(event)
            if isinstance(event, Removed):
                break
        ended.set()

    threading.Thread(target=listen, daemon=True).start()
    shape = faience.add(("m.ply", coloured_triangle()), wait=60)
    faience.remove(shape.id)
    assert ended.wait(60)
    assert told[-1] == Removed(shape.id)
    assert {event.shape.id for event in told if isinstance(event, Changed)} <= {shape.id}
