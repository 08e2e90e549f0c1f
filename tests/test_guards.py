"""Closed doors stay closed."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from pydantic import SecretStr

from tests.problems import problem
from tests.serving import Serving, serving, settings_for

KEYS = (SecretStr("first-key"), SecretStr("second-key"))


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Serving]:
    settings = settings_for(tmp_path_factory.mktemp("library"), workers=0, api_keys=KEYS)
    with serving(settings) as running:
        yield running


CALLS = [
    ("GET", "/v1/shapes"),
    ("POST", "/v1/shapes"),
    ("GET", "/v1/shapes/x"),
    ("PATCH", "/v1/shapes/x"),
    ("DELETE", "/v1/shapes/x"),
    ("GET", "/v1/shapes/x/files/a"),
    ("GET", "/v1/shapes/x/thumbnail.png"),
    ("GET", "/v1/shapes/x/preview.glb"),
    ("GET", "/v1/shapes/x/descriptors"),
    ("GET", "/v1/shapes/x/similar"),
    ("POST", "/v1/search"),
    ("GET", "/v1/methods"),
    ("GET", "/v1/events"),
    ("GET", "/metrics"),
]


@pytest.mark.parametrize(("method", "path"), CALLS)
def test_nothing_of_the_library_is_told_without_a_key(service: Serving, method: str, path: str) -> None:
    body = {"name": "x"} if method == "PATCH" else None
    for header in ({}, {"authorization": "Bearer wrong"}, {"authorization": "Basic first-key"}):
        answer = service.client.request(method, path, headers=header, json=body)
        problem(answer, 401, "unauthorised")
        assert answer.headers["www-authenticate"] == "Bearer"


def test_every_call_of_the_interface_is_in_the_list_above_or_open(service: Serving) -> None:
    paths = service.client.get("/openapi.json").json()["paths"]
    described = {path.replace("{shape_id}", "x").replace("{name}", "a") for path in paths}
    assert described == {path for _, path in CALLS} | {"/livez", "/readyz"}


@pytest.mark.parametrize("key", ["first-key", "second-key"])
def test_any_known_key_opens(service: Serving, key: str) -> None:
    answer = service.client.get("/v1/shapes", headers={"authorization": f"Bearer {key}"})
    assert answer.status_code == 200


@pytest.mark.parametrize("path", ["/livez", "/readyz", "/", "/docs", "/openapi.json", "/static/page.js"])
def test_what_holds_nothing_of_the_library_is_open(service: Serving, path: str) -> None:
    assert service.client.get(path).status_code == 200


def test_a_page_of_another_site_may_not_change_anything(service: Serving) -> None:
    header = {"authorization": "Bearer first-key", "origin": "https://elsewhere.example"}
    problem(service.client.delete("/v1/shapes/x", headers=header), 403, "cross_origin")
    own = {**header, "origin": str(service.client.base_url).rstrip("/")}
    problem(service.client.delete("/v1/shapes/x", headers=own), 404, "not_found")
    answer = service.client.get("/v1/shapes", headers=header)
    assert "access-control-allow-origin" not in answer.headers


@pytest.mark.parametrize(("insecure", "status"), [(False, 403), (True, 200)])
def test_without_keys_only_this_machines_own_names_are_answered(
    tmp_path: Path, insecure: bool, status: int
) -> None:
    with serving(settings_for(tmp_path, workers=0, insecure=insecure)) as open_service:
        port = open_service.client.base_url.port
        for host in ("127.0.0.1", f"localhost:{port}", f"[::1]:{port}"):
            assert open_service.client.get("/v1/shapes", headers={"host": host}).status_code == 200
        answer = open_service.client.get("/v1/shapes", headers={"host": "rebound.example"})
        assert answer.status_code == status
    if status == 403:
        problem(answer, 403, "foreign_host")


def test_with_keys_any_name_is_answered(service: Serving) -> None:
    headers = {"authorization": "Bearer first-key", "host": "faience.example"}
    assert service.client.get("/v1/shapes", headers=headers).status_code == 200
