"""`faience learn-vocabulary`: a new vocabulary is in use afterwards."""

from pathlib import Path

import pytest

from tests.commanding import json_lines, make_meshes, make_quick, plain_line, run
from tests.serving import fake_vocabulary, open_fake_library, settings_for


@pytest.fixture(autouse=True)
def _quick(monkeypatch: pytest.MonkeyPatch) -> None:
    make_quick(monkeypatch)


def test_the_learnt_vocabulary_is_active(tmp_path: Path) -> None:
    make_meshes(tmp_path / "in", 5)
    run("index", tmp_path / "in", "--data-dir", tmp_path / "lib")
    result = run("learn-vocabulary", "--data-dir", tmp_path / "lib", "--json")
    assert result.exit_code == 0
    line = json_lines(result)[0]
    assert line.keys() == {"vocabulary", "shapes", "seconds"}
    assert line["shapes"] == 5
    assert line["vocabulary"] != fake_vocabulary().id
    library = open_fake_library(settings_for(tmp_path / "lib"))
    active = library.catalogue.active_vocabulary()
    library.close()
    assert active is not None
    assert active.id == line["vocabulary"]


def test_an_empty_library_is_one_plain_line(tmp_path: Path) -> None:
    (tmp_path / "lib").mkdir()
    result = run("learn-vocabulary", "--data-dir", tmp_path / "lib")
    assert result.exit_code == 1
    assert "is empty" in plain_line(result)
