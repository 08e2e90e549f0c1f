"""Every answer carries the safe headers, whoever made it."""

from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest
from pydantic import SecretStr

from service.http.headers import SAFE_HEADERS
from tests.serving import Serving, serving, settings_for

KEY = {"authorization": "Bearer a-long-secret"}


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Serving]:
    folder = tmp_path_factory.mktemp("library")
    settings = settings_for(
        folder, workers=0, api_keys=(SecretStr("a-long-secret"),), uploads_per_minute=1, max_body_bytes=2**20
    )
    with serving(settings) as running:
        running.client.post("/v1/search", headers=KEY)  # the one upload of this minute
        yield running


def check(answer: httpx.Response, status: int) -> None:
    assert answer.status_code == status
    for name, value in SAFE_HEADERS.items():
        assert answer.headers[name] == value, (status, name)


@pytest.mark.parametrize(
    ("method", "path", "header", "status"),
    [
        ("GET", "/v1/methods", KEY, 200),
        ("GET", "/v1/shapes", KEY, 200),
        ("GET", "/metrics", KEY, 200),
        ("GET", "/", {}, 200),
        ("GET", "/docs", {}, 200),
        ("GET", "/static/app.js", {}, 200),
        ("GET", "/openapi.json", {}, 200),
        ("GET", "/livez", {}, 200),
        ("GET", "/favicon.ico", {}, 307),
        ("GET", "/v1/methods/", KEY, 307),
        ("GET", "/v1/shapes", {}, 401),
        ("DELETE", "/v1/shapes/x", {**KEY, "origin": "https://elsewhere.example"}, 403),
        ("GET", "/v1/shapes/x", KEY, 404),
        ("GET", "/static/none.js", {}, 404),
        ("GET", "/nowhere", {}, 404),
        ("OPTIONS", "/v1/shapes", {}, 405),
        ("PUT", "/v1/shapes", KEY, 405),
        ("GET", "/v1/shapes?limit=none", KEY, 422),
        ("POST", "/v1/shapes", KEY, 429),
    ],
)
def test_every_answer_carries_the_safe_headers(
    service: Serving, method: str, path: str, header: dict[str, str], status: int
) -> None:
    check(service.client.request(method, path, headers=header), status)


def test_a_body_that_is_too_large_is_refused_with_them(service: Serving) -> None:
    header = {**KEY, "content-type": "application/json"}
    check(service.client.patch("/v1/shapes/x", headers=header, content=bytes(2 * 2**20)), 413)


def test_a_stream_carries_them(service: Serving) -> None:
    with service.client.stream("GET", "/v1/events", headers=KEY) as answer:
        check(answer, 200)


@pytest.mark.parametrize("error", [RuntimeError("secret"), OSError(5, "secret"), KeyError("secret")])
def test_a_defect_of_our_own_carries_them(
    service: Serving, monkeypatch: pytest.MonkeyPatch, error: Exception
) -> None:
    def fail(*_: object) -> None:
        raise error

    monkeypatch.setattr(service.library.catalogue, "get", fail)
    check(service.client.get("/v1/shapes/x", headers=KEY), 500)


def test_a_database_that_is_away_is_told_with_them(tmp_path: Path) -> None:
    with serving(settings_for(tmp_path, workers=0)) as running:
        running.library.engine.dispose()
        (tmp_path / "catalogue.sqlite3").rename(tmp_path / "elsewhere")
        (tmp_path / "catalogue.sqlite3").mkdir()
        check(running.client.get("/readyz"), 503)
        (tmp_path / "catalogue.sqlite3").rmdir()
        (tmp_path / "elsewhere").rename(tmp_path / "catalogue.sqlite3")
