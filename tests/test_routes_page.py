"""Page and manual work without any other machine."""

import hashlib
import posixpath
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from service.http.page_files import page_files
from service.http.routes import page
from tests.problems import problem
from tests.serving import Serving, serving, settings_for

PAGES = ("/", "/docs", *(f"/static/{name}" for name in page_files() if not name.startswith("vendor/")))


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


@pytest.mark.parametrize(
    "name",
    [
        "nothing.js",
        "..%2fsettings.py",
        "index.html%00",
        "vendor/refresh.sh",
        "vendor",
        "vendor/%2e%2e/app.js",
    ],
)
def test_nothing_but_the_pages_files_is_served(service: Serving, name: str) -> None:
    problem(service.client.get(f"/static/{name}"), 404, "file_missing")


def test_a_file_that_the_browser_has_is_not_sent_again(service: Serving) -> None:
    first = service.client.get("/static/app.js")
    again = service.client.get("/static/app.js", headers={"If-None-Match": first.headers["etag"]})
    assert (again.status_code, again.content) == (304, b"")


def test_files_travel_packed_where_the_browser_can_unpack_them(service: Serving) -> None:
    packed = service.client.get("/static/vendor/three.js")
    plain = service.client.get("/static/vendor/three.js", headers={"Accept-Encoding": "identity"})
    assert packed.content == plain.content
    assert int(packed.headers["content-length"]) < len(plain.content) / 3


def test_every_module_imports_files_that_are_there() -> None:
    for name, file in page_files().items():
        if not name.endswith(".js") or name.startswith("vendor/"):
            continue
        for address in re.findall(r"""(?:from|import)\s*\(?["']([^"']+)["']""", file.content.decode()):
            assert posixpath.normpath(f"{posixpath.dirname(name)}/{address}").lstrip("/") in page_files(), (
                name,
                address,
            )


def test_bundles_are_those_that_were_noted_when_they_were_made() -> None:
    noted = (Path(page.__file__).parents[2] / "static/vendor/README.md").read_text()
    for name, file in page_files().items():
        if name.startswith("vendor/"):
            assert hashlib.sha256(file.content).hexdigest() in noted, name


def test_a_tab_has_its_picture(service: Serving) -> None:
    answer = service.client.get("/favicon.ico", follow_redirects=True)
    assert answer.headers["content-type"].startswith("image/svg+xml")
