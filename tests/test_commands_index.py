"""`faience index`: accepted once, known afterwards, refusals told with their codes."""

import signal
import time
from pathlib import Path

import pytest

from index.shapes import Status
from service.library import Library
from tests.commanding import MAIN, json_lines, make_meshes, make_quick, plain_line, run, start
from tests.serving import open_fake_library, settings_for


@pytest.fixture(autouse=True)
def _quick(monkeypatch: pytest.MonkeyPatch) -> None:
    make_quick(monkeypatch)


def _library(folder: Path) -> Library:
    return open_fake_library(settings_for(folder))


def test_a_folder_is_accepted_once_and_known_afterwards(tmp_path: Path) -> None:
    make_meshes(tmp_path / "in", 3)
    first = json_lines(run("index", tmp_path / "in", "--data-dir", tmp_path / "lib", "--json"))
    assert [line["outcome"] for line in first[:-1]] == ["accepted"] * 3
    assert {Path(line["path"]).name for line in first[:-1]} == {"mesh0.ply", "mesh1.ply", "mesh2.ply"}
    assert first[-1].keys() == {"accepted", "known", "refused", "seconds"}
    assert (first[-1]["accepted"], first[-1]["known"], first[-1]["refused"]) == (3, 0, 0)
    second = json_lines(run("index", tmp_path / "in", "--data-dir", tmp_path / "lib", "--json"))
    assert [line["outcome"] for line in second[:-1]] == ["known"] * 3
    assert {line["id"] for line in first[:-1]} == {line["id"] for line in second[:-1]}


def test_shapes_are_named_by_their_place_below_the_argument(tmp_path: Path) -> None:
    make_meshes(tmp_path / "in" / "deep", 1)
    run("index", tmp_path / "in", "--data-dir", tmp_path / "lib")
    library = _library(tmp_path / "lib")
    assert [shape.name for shape in library.catalogue.list().items] == ["deep/mesh0.ply"]
    library.close()


def test_one_content_under_two_names_is_one_shape(tmp_path: Path) -> None:
    make_meshes(tmp_path / "in" / "a", 1)
    make_meshes(tmp_path / "in" / "b", 1)
    lines = json_lines(run("index", tmp_path / "in", "--data-dir", tmp_path / "lib", "--json"))
    assert sorted(line["outcome"] for line in lines[:-1]) == ["accepted", "known"]
    assert lines[0]["id"] == lines[1]["id"]


def test_refusals_are_told_and_the_rest_goes_on(tmp_path: Path) -> None:
    paths = make_meshes(tmp_path / "in", 3)
    paths[0].write_bytes(b"")
    paths[2].rename(paths[2].with_name("crash.ply"))
    result = run("index", tmp_path / "in", "--data-dir", tmp_path / "lib", "--json")
    outcomes = {Path(line["path"]).name: (line["outcome"], line["code"]) for line in json_lines(result)[:-1]}
    assert outcomes["mesh0.ply"] == ("refused", "empty")
    assert outcomes["mesh1.ply"] == ("accepted", None)
    assert outcomes["crash.ply"] == ("refused", "gave_up")
    assert result.exit_code == 0


def test_the_summary_shows_codes_and_reasons(tmp_path: Path) -> None:
    paths = make_meshes(tmp_path / "in", 2)
    paths[0].write_bytes(b"")
    result = run("index", tmp_path / "in", "--data-dir", tmp_path / "lib")
    assert "accepted" in result.stdout
    assert "empty" in result.stdout
    assert "2/2" in result.stderr


def test_nothing_readable_is_a_failure(tmp_path: Path) -> None:
    make_meshes(tmp_path / "in", 1)[0].write_bytes(b"")
    result = run("index", tmp_path / "in", "--data-dir", tmp_path / "lib")
    assert result.exit_code == 1
    assert "none of the meshes could be read" in plain_line(result)


def test_a_wrong_path_or_an_empty_folder_is_one_plain_line(tmp_path: Path) -> None:
    missing = run("index", tmp_path / "nothere", "--data-dir", tmp_path / "lib")
    assert missing.exit_code == 1
    assert "there is no file or folder" in plain_line(missing)
    (tmp_path / "in").mkdir()
    empty = run("index", tmp_path / "in", "--data-dir", tmp_path / "lib")
    assert empty.exit_code == 1
    assert "there is no .ply, .obj or .zip" in plain_line(empty)
    assert not (tmp_path / "lib").exists()


def test_ctrl_c_leaves_a_library_that_goes_on(tmp_path: Path) -> None:
    paths = make_meshes(tmp_path / "in", 3)
    paths[0].rename(tmp_path / "in" / "hang.ply")
    prepare = "import pytest; from tests.commanding import make_quick; make_quick(pytest.MonkeyPatch())"
    arguments: list[str | Path] = ["index", tmp_path / "in", "--data-dir", tmp_path / "lib"]
    with start(*arguments, script=f"{prepare}; {MAIN}") as process:
        library = _waited_for(tmp_path / "lib", ready=2)
        process.send_signal(signal.SIGINT)
        errors = process.communicate(timeout=120)[1]
    assert process.returncode == 130
    assert "the same command goes on from here" in errors
    assert "Traceback" not in errors
    counts = library.catalogue.counts()
    assert (counts[Status.READY], counts[Status.QUEUED], counts[Status.PROCESSING]) == (2, 1, 0)
    library.close()


def _waited_for(folder: Path, ready: int) -> Library:
    """Return the library once so many shapes are ready; the bound is only for a test that would fail."""
    deadline = time.monotonic() + 120
    while time.monotonic() < deadline:
        if (folder / "catalogue.sqlite3").exists():
            library = _library(folder)
            counts = library.catalogue.counts()
            if counts[Status.READY] == ready and counts[Status.PROCESSING] == 1:
                return library
            library.close()
        time.sleep(0.2)
    raise TimeoutError("the command indexed nothing")
