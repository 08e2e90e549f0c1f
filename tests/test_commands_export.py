"""`faience export`: what it says, and how it ends."""

import json
import signal
from pathlib import Path

import pytest

from tests.backups import add_ready, fill, opened, parts_of
from tests.commanding import MAIN, json_lines, make_quick, plain_line, run, start


@pytest.fixture(autouse=True)
def _quick(monkeypatch: pytest.MonkeyPatch) -> None:
    make_quick(monkeypatch)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return the folder of a filled library."""
    with opened(tmp_path / "lib") as library:
        fill(library)
    return tmp_path / "lib"


def test_json_ends_with_one_line_that_tells_all(tmp_path: Path, folder: Path) -> None:
    result = run("export", tmp_path / "library.tar", "--data-dir", folder, "--json")
    assert result.exit_code == 0
    (line,) = json_lines(result)
    files = [name for name in parts_of(tmp_path / "library.tar") if name.startswith("files/")]
    assert line.pop("seconds") > 0
    size = (tmp_path / "library.tar").stat().st_size
    assert line == {"shapes": 7, "files": len(files), "bytes": size, "left_out": [], "damaged": []}


def test_people_are_told_in_words(tmp_path: Path, folder: Path) -> None:
    result = run("export", tmp_path / "library.tar", "--data-dir", folder)
    assert result.exit_code == 0
    assert "7 shapes" in result.stdout
    assert "7/7" in result.stderr


def test_an_existing_file_needs_a_word(tmp_path: Path, folder: Path) -> None:
    (tmp_path / "library.tar").write_bytes(b"older")
    result = run("export", tmp_path / "library.tar", "--data-dir", folder)
    assert result.exit_code == 1
    assert "--replace replaces it" in plain_line(result)
    assert run("export", tmp_path / "library.tar", "--data-dir", folder, "--replace").exit_code == 0
    assert "library.json" in parts_of(tmp_path / "library.tar")


def test_a_wrong_place_or_library_is_one_plain_line(tmp_path: Path, folder: Path) -> None:
    for place in (tmp_path, tmp_path / "nowhere" / "library.tar"):
        result = run("export", place, "--data-dir", folder)
        assert result.exit_code == 1
        assert "must be a file in a folder that exists" in plain_line(result)
    result = run("export", tmp_path / "library.tar", "--data-dir", tmp_path / "nowhere")
    assert result.exit_code == 1
    assert "there is no library" in plain_line(result)
    assert not (tmp_path / "library.tar").exists()


def test_damage_is_listed_and_has_an_exit_code_of_its_own(tmp_path: Path) -> None:
    with opened(tmp_path / "lib") as library:
        shapes = [add_ready(library, red) for red in range(25)]
        for shape in shapes:
            library.files.delete(f"shapes/{shape.id}/thumbnail.png")
    result = run("export", tmp_path / "library.tar", "--data-dir", tmp_path / "lib")
    assert result.exit_code == 3
    assert result.stdout.count("file_missing: shapes/") == 20
    assert "and 5 more" in result.stdout
    assert "25 damages" in plain_line(result)
    assert len(parts_of(tmp_path / "library.tar")["tables/shapes.jsonl"].splitlines()) == 25
    result = run("export", tmp_path / "library.tar", "--data-dir", tmp_path / "lib", "--replace", "--json")
    assert result.exit_code == 3
    line = json.loads(result.stdout)
    assert {damage["shape"] for damage in line["damaged"]} == {shape.id for shape in shapes}
    assert {damage["code"] for damage in line["damaged"]} == {"file_missing"}


SLOW = """
import time
from service.backup import exporting
added = exporting._add_shape
def slowly(*arguments):
    added(*arguments)
    print("one", flush=True)
    time.sleep(60)
exporting._add_shape = slowly
import pytest; from tests.commanding import make_quick; make_quick(pytest.MonkeyPatch())
"""


def test_ctrl_c_leaves_nothing_behind(tmp_path: Path, folder: Path) -> None:
    (tmp_path / "out").mkdir()
    arguments: list[str | Path] = ["export", tmp_path / "out" / "library.tar", "--data-dir", folder]
    with start(*arguments, script=SLOW + MAIN) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "one\n"
        process.send_signal(signal.SIGINT)
        errors = process.communicate(timeout=120)[1]
    assert process.returncode == 130
    assert "no file was written" in errors
    assert "Traceback" not in errors
    assert list((tmp_path / "out").iterdir()) == []
