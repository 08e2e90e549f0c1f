"""The parts of a library are looked after, each for itself."""

from pathlib import Path

import pytest

from index.errors import NewerDescriptions, StorageUnreachable
from service.key_ring import KeyRing
from service.watching.checks import checks_of
from service.watching.first_load import FirstLoad
from service.watching.readiness import Readiness, Unready
from tests.serving import open_fake_library, settings_for


def test_an_index_that_is_loaded_an_unreadable_folder_and_old_keys_are_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    settings = settings_for(tmp_path / "library")
    library = open_fake_library(settings)
    keys = KeyRing(settings, list, patience=-1)
    load = FirstLoad(library)
    monkeypatch.setattr("os.access", lambda *_: False)  # root may everything
    with pytest.raises(Unready) as raised:
        Readiness(checks_of(library, keys, load)).look()
    parts = raised.value.members["parts"]
    assert parts["catalogue"] == "ok"
    assert "data folder" in parts["files"]
    assert parts["keys"] == "could not be read for too long"
    assert parts["index"] == "is being loaded"
    library.close()


def test_the_first_load_ends_whether_or_not_it_succeeds(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    library = open_fake_library(settings_for(tmp_path / "library"))
    load = FirstLoad(library)
    seen = [load.done]
    with load.running():
        pass
    assert [*seen, load.done] == [False, True]
    assert list(library.searcher.revisions()) == ["fused"]

    def broken(_: str) -> None:
        raise OSError

    monkeypatch.setattr(library.searcher, "load", broken)
    again = FirstLoad(library)
    with again.running():
        pass
    assert again.done
    library.close()


def test_a_bucket_that_is_away_and_newer_descriptions_are_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    settings = settings_for(tmp_path / "library")
    library = open_fake_library(settings)

    def away() -> None:
        raise StorageUnreachable("the storage does not answer")

    def behind(*_: object) -> None:
        raise NewerDescriptions("a newer version described the shapes")

    monkeypatch.setattr(library.files, "check", away)
    monkeypatch.setattr("service.watching.checks.check_not_behind", behind)
    with pytest.raises(Unready) as raised:
        Readiness(checks_of(library, KeyRing(settings, list), FirstLoad(library))).look()
    parts = raised.value.members["parts"]
    assert "does not answer" in parts["files"]
    assert "newer version" in parts["descriptions"]
    assert parts["catalogue"] == "ok"
    library.close()
