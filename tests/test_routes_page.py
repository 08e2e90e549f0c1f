"""Page and manual work without any other machine."""

import re
from collections.abc import Iterator

import pytest

from tests.problems import problem
from tests.serving import Serving, serving, settings_for

PAGES = ("/", "/docs", "/static/page.js", "/static/page.css", "/static/icon.svg")


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Serving]:
    with serving(settings_for(tmp_path_factory.mktemp("library"), workers=0)) as running:
        yield running


@pytest.mark.parametrize("path", PAGES)
def test_nothing_is_loaded_from_outside(service: Serving, path: str) -> None:
    answer = service.client.get(path)
    assert answer.status_code == 200
    addresses = re.findall(r"(?:https?:)?//[a-z0-9.-]+\.[a-z]+", answer.text)
    assert set(addresses) <= {"http://www.w3.org"}  # a namespace's name, never fetched
    assert "'self'" in answer.headers["content-security-policy"]
    assert "unsafe" not in answer.headers["content-security-policy"]


def test_every_local_address_in_the_page_is_served(service: Serving) -> None:
    text = service.client.get("/").text
    for address in re.findall(r'(?:href|src)="(/[^"]*)"', text):
        assert service.client.get(address).status_code == 200, address


def test_the_page_fits_a_phone_and_speaks_a_language(service: Serving) -> None:
    text = service.client.get("/").text
    assert '<html lang="en">' in text
    assert 'name="viewport"' in text


def test_the_manual_names_every_call(service: Serving) -> None:
    text = service.client.get("/docs").text
    paths = service.client.get("/openapi.json").json()["paths"]
    for path, methods in paths.items():
        for method in methods:
            assert f"{method.upper()} {path}" in text


@pytest.mark.parametrize("name", ["nothing.js", "..%2fsettings.py", "index.html%00"])
def test_nothing_but_the_pages_files_is_served(service: Serving, name: str) -> None:
    problem(service.client.get(f"/static/{name}"), 404, "file_missing" if "%2f" not in name else "not_found")


def test_a_tab_has_its_picture(service: Serving) -> None:
    answer = service.client.get("/favicon.ico", follow_redirects=True)
    assert answer.headers["content-type"].startswith("image/svg+xml")
