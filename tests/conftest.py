"""Where the shared meshes are, for the tests that use them."""

import os
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import settings
from playwright.sync_api import Browser

from tests.browsing import chromium_path, launched
from tests.databases import DATABASES, INDEXES, KINDS, engines_let_go, postgresql
from tests.storages import KEPT, PLACES, STORAGES, object_storage

settings.register_profile("shared machine", deadline=None)  # others work on it too: time proves nothing
settings.load_profile("shared machine")

SHARED = Path(__file__).resolve().parents[2] / "shared"


def _folder(name: str) -> Path:
    folder = SHARED / name
    if not folder.is_dir():
        pytest.skip(f"shared meshes are not here: {name}")
    return folder


@pytest.fixture(scope="session")
def data_folder() -> Path:
    """Real coloured meshes: posed models, clutter, textured objects."""
    return _folder("data")


@pytest.fixture(scope="session")
def odd_meshes_folder() -> Path:
    """Odd and broken meshes, with what is expected of each."""
    return _folder("odd-meshes")


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    """Start the system's Chromium, without a window."""
    executable = chromium_path()
    if executable is None:
        pytest.skip("no Chromium on this machine; with apt: apt-get install chromium")
    with launched(executable) as started:
        yield started


@pytest.fixture(scope="session")
def database_server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """Start PostgreSQL once for all tests of a process that need it."""
    with postgresql(tmp_path_factory.mktemp("postgresql") / "data") as address:
        yield address


@pytest.fixture(autouse=True)
def _let_go(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Close what a test leaves open; a connection would complain whenever it is collected, in any test."""
    with engines_let_go(monkeypatch):
        yield


@pytest.fixture(scope="module", params=KINDS)
def database(request: pytest.FixtureRequest) -> Iterator[str]:
    """Run the tests of a module twice, with catalogues in SQLite and in PostgreSQL."""
    kind: str = request.param
    if kind == "postgresql":
        DATABASES.server = request.getfixturevalue("database_server")
    DATABASES.kind = kind
    yield kind
    DATABASES.kind = "sqlite"


@pytest.fixture(scope="session")
def object_server() -> Iterator[str]:
    """Start an S3 server once for all tests of a process that need it."""
    with object_storage() as address:
        os.environ["AWS_ENDPOINT_URL"] = address
        yield address
        del os.environ["AWS_ENDPOINT_URL"]


@pytest.fixture(scope="module", params=STORAGES)
def storage(request: pytest.FixtureRequest) -> Iterator[str]:
    """Run the tests of a module twice, with files in folders and in a bucket."""
    kind: str = request.param
    if kind == "s3":
        request.getfixturevalue("object_server")
    PLACES.kind = kind
    yield kind
    PLACES.kind = "local"


@pytest.fixture(scope="module", params=KEPT)
def kept(request: pytest.FixtureRequest) -> Iterator[str]:
    """Run the tests of a module with both databases, then with files in a bucket."""
    kind: str = request.param
    if kind == "postgresql":
        DATABASES.server = request.getfixturevalue("database_server")
        DATABASES.kind = kind
    if kind == "s3":
        request.getfixturevalue("object_server")
        PLACES.kind = kind
    yield kind
    DATABASES.kind, PLACES.kind = "sqlite", "local"


@pytest.fixture(scope="module", params=INDEXES)
def indexed(request: pytest.FixtureRequest) -> Iterator[str]:
    """Run the tests of a module with vectors in memory, on both databases, and in PostgreSQL."""
    index, kind = str(request.param).split(", ")
    if kind == "postgresql":
        DATABASES.server = request.getfixturevalue("database_server")
    DATABASES.kind, DATABASES.index = kind, index
    yield index
    DATABASES.kind, DATABASES.index = "sqlite", "memory"
