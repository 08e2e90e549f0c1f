"""The interface describes itself completely."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from service.app import create_app
from tests.serving import settings_for

PROMISED = {
    ("post", "/v1/shapes"),
    ("get", "/v1/shapes"),
    ("get", "/v1/shapes/{shape_id}"),
    ("patch", "/v1/shapes/{shape_id}"),
    ("delete", "/v1/shapes/{shape_id}"),
    ("get", "/v1/shapes/{shape_id}/files/{name}"),
    ("get", "/v1/shapes/{shape_id}/thumbnail.png"),
    ("get", "/v1/shapes/{shape_id}/preview.glb"),
    ("get", "/v1/shapes/{shape_id}/descriptors"),
    ("get", "/v1/shapes/{shape_id}/similar"),
    ("get", "/v1/shapes/{shape_id}/why/{other}"),
    ("get", "/v1/shapes/{shape_id}/why/{other}/query.glb"),
    ("get", "/v1/shapes/{shape_id}/why/{other}/result.glb"),
    ("post", "/v1/shapes/{shape_id}/retry"),
    ("post", "/v1/search"),
    ("get", "/v1/methods"),
    ("get", "/v1/duplicates"),
    ("get", "/v1/duplicates/dismissals"),
    ("put", "/v1/duplicates/dismissals/{one}/{other}"),
    ("delete", "/v1/duplicates/dismissals/{one}/{other}"),
    ("get", "/v1/tags"),
    ("get", "/v1/counts"),
    ("get", "/v1/queue"),
    ("get", "/v1/queries/{query_id}"),
    ("get", "/v1/queries/{query_id}/similar"),
    ("get", "/v1/queries/{query_id}/thumbnail.png"),
    ("get", "/v1/queries/{query_id}/preview.glb"),
    ("get", "/v1/queries/{query_id}/why/{other}"),
    ("get", "/v1/queries/{query_id}/why/{other}/query.glb"),
    ("get", "/v1/queries/{query_id}/why/{other}/result.glb"),
    ("get", "/v1/events"),
    ("get", "/livez"),
    ("get", "/readyz"),
    ("get", "/metrics"),
}


@pytest.fixture(scope="module")
def interface() -> dict[str, Any]:
    return create_app(settings_for(Path("unused"))).openapi()


def calls(interface: dict[str, Any]) -> Iterator[tuple[str, str, dict[str, Any]]]:
    for path, methods in interface["paths"].items():
        for method, call in methods.items():
            yield method, path, call


def references(part: object) -> Iterator[str]:
    if isinstance(part, dict):
        for name, value in part.items():
            if name == "$ref":
                yield value
            yield from references(value)
    elif isinstance(part, list):
        for value in part:
            yield from references(value)


def test_every_call_of_the_design_is_there_and_no_other(interface: dict[str, Any]) -> None:
    assert {(method, path) for method, path, _ in calls(interface)} >= PROMISED


def test_every_call_is_named_once_and_explained(interface: dict[str, Any]) -> None:
    names = [call["operationId"] for _, _, call in calls(interface)]
    assert len(set(names)) == len(names)
    for _, path, call in calls(interface):
        assert call["summary"], path
        assert call["description"], path
        assert all(
            part.get("description")
            for part in call.get("parameters", [])
            if part["in"] == "query" and part["name"] not in ("status",)
        ), path


def test_every_error_is_a_problem_and_every_guarded_call_may_ask_for_a_key(interface: dict[str, Any]) -> None:
    for _, path, call in calls(interface):
        for status, answer in call["responses"].items():
            if int(status) >= 400:
                assert list(answer["content"]) == ["application/problem+json"], (path, status)
        if path.startswith("/v1"):
            assert {"401", "422", "500"} <= set(call["responses"]), path


def test_every_reference_leads_somewhere(interface: dict[str, Any]) -> None:
    for reference in references(interface):
        part: Any = interface
        for step in reference.removeprefix("#/").split("/"):
            part = part[step]
        assert part


def test_uploads_are_described_as_forms(interface: dict[str, Any]) -> None:
    form = interface["paths"]["/v1/shapes"]["post"]["requestBody"]["content"]["multipart/form-data"]["schema"]
    assert set(form["properties"]) == {"files", "name", "metadata", "allow_untextured"}
    assert form["required"] == ["files"]
