"""Where the shared meshes are, for the tests that use them."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import settings
from playwright.sync_api import Browser

from tests.browsing import chromium_path, launched

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
