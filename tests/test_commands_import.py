"""`faience import`: what it says, how it ends, and that a service finds what came."""

import json
import signal
from pathlib import Path

import pytest

from tests.backups import add_ready, exported, files_of, forged, opened
from tests.commanding import MAIN, json_lines, make_quick, plain_line, run, start
from tests.serving import serving, settings_for


@pytest.fixture(autouse=True)
def _quick(monkeypatch: pytest.MonkeyPatch) -> None:
    make_quick(monkeypatch)


def test_json_ends_with_one_line_that_tells_all(tmp_path: Path) -> None:
    archive = exported(tmp_path)
    result = run("import", archive, "--data-dir", tmp_path / "to", "--json")
    assert result.exit_code == 0
    (line,) = json_lines(result)
    assert line.pop("seconds") > 0
    with opened(tmp_path / "from") as library:
        files = len(files_of(library))
    size = archive.stat().st_size
    assert line == {"shapes": 7, "files": files, "bytes": size, "left_out": [], "damaged": []}


def test_people_are_told_in_words(tmp_path: Path) -> None:
    result = run("import", exported(tmp_path), "--data-dir", tmp_path / "to")
    assert result.exit_code == 0
    assert "7 shapes" in result.stdout


def test_refusals_are_one_line_with_a_code(tmp_path: Path) -> None:
    archive = exported(tmp_path)
    result = run("import", archive, "--data-dir", tmp_path / "from")
    assert result.exit_code == 1
    assert "has 7" in plain_line(result)
    assert "(library_not_empty)" in plain_line(result)
    (tmp_path / "notes.txt").write_text("no library at all")
    result = run("import", tmp_path / "notes.txt", "--data-dir", tmp_path / "to")
    assert result.exit_code == 1
    assert "(damaged_export)" in plain_line(result)
    header = json.dumps({"format": 7, "schema": "0001"}).encode()
    newer = forged(archive, lambda parts: {**parts, "library.json": header})
    result = run("import", newer, "--data-dir", tmp_path / "to")
    assert result.exit_code == 1
    assert "(newer_format)" in plain_line(result)


def test_a_file_that_is_not_there_is_one_plain_line(tmp_path: Path) -> None:
    for place in (tmp_path / "nothere.tar", tmp_path):
        result = run("import", place, "--data-dir", tmp_path / "to")
        assert result.exit_code == 1
        assert "there is no file" in plain_line(result)
    assert not (tmp_path / "to").exists()


def test_damage_from_before_has_an_exit_code_of_its_own(tmp_path: Path) -> None:
    with opened(tmp_path / "from") as library:
        shape = add_ready(library, 10)
        library.files.delete(f"shapes/{shape.id}/preview.glb")
    run("export", tmp_path / "library.tar", "--data-dir", tmp_path / "from")
    result = run("import", tmp_path / "library.tar", "--data-dir", tmp_path / "to", "--json")
    assert result.exit_code == 3
    damage = {"code": "file_missing", "shape": shape.id, "what": f"shapes/{shape.id}/preview.glb"}
    assert json.loads(result.stdout)["damaged"] == [damage]


def test_a_running_service_shows_what_came_and_works_on(tmp_path: Path) -> None:
    archive = exported(tmp_path)
    with serving(settings_for(tmp_path / "to")) as running:
        result = run("import", archive, "--data-dir", tmp_path / "to", "--json")
        assert result.exit_code == 0, result.stderr
        shapes = running.client.get("/v1/shapes").json()["items"]
        assert len(shapes) == 7
        states = [running.settled(shape["id"])["status"] for shape in shapes]
        assert sorted(states) == ["failed", *["ready"] * 6]  # what waited is done now
        found = running.client.get(f"/v1/shapes/{shapes[-1]['id']}/similar").json()["results"]
        assert len(found) == 5
        assert running.client.get(f"/v1/shapes/{shapes[-1]['id']}/thumbnail.png").status_code == 200


SLOW = """
import time
from service.backup import importing
put = importing._put_files
def slowly(*arguments):
    put(*arguments)
    print("put", flush=True)
    time.sleep(60)
importing._put_files = slowly
import pytest; from tests.commanding import make_quick; make_quick(pytest.MonkeyPatch())
"""


def test_ctrl_c_leaves_nothing_behind(tmp_path: Path) -> None:
    arguments: list[str | Path] = ["import", exported(tmp_path), "--data-dir", tmp_path / "to"]
    with start(*arguments, script=SLOW + MAIN) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "put\n"
        process.send_signal(signal.SIGINT)
        errors = process.communicate(timeout=120)[1]
    assert process.returncode == 130
    assert "nothing was imported" in errors
    assert "Traceback" not in errors
    with opened(tmp_path / "to") as library:
        assert files_of(library) == {}
        assert library.catalogue.list().items == ()
