"""`faience duplicates`: groups as tables or as lines of JSON."""

from pathlib import Path

import pytest

from tests.commanding import json_lines, make_quick, plain_line, run
from tests.test_duplicates import FAR, ONE, OTHER, exported_anew

MESHES = {"a": ONE, "b": exported_anew(ONE, 1), "c": FAR, "d": exported_anew(FAR, 1), "e": OTHER}


@pytest.fixture(autouse=True)
def _quick(monkeypatch: pytest.MonkeyPatch) -> None:
    make_quick(monkeypatch)


def indexed(folder: Path, *names: str) -> Path:
    """Make a library of some of the meshes."""
    meshes = folder / "in"
    meshes.mkdir()
    for name in names:
        (meshes / f"{name}.ply").write_bytes(MESHES[name])
    assert run("index", meshes, "--data-dir", folder / "library").exit_code == 0
    return folder / "library"


def test_each_group_is_a_line_of_json(tmp_path: Path) -> None:
    library = indexed(tmp_path, *MESHES)
    lines = json_lines(run("duplicates", "--data-dir", library, "--json"))
    found = {tuple(sorted(shape["name"] for shape in line["shapes"])): line for line in lines}
    assert found.keys() == {("a.ply", "b.ply", "e.ply"), ("c.ply", "d.ply")}
    pair = found["c.ply", "d.ply"]
    assert pair["relation"] == "same_shape"
    (evidence,) = pair["evidence"]
    assert {evidence["one"], evidence["other"]} == {shape["id"] for shape in pair["shapes"]}
    assert evidence["relation"] == "same_shape"


def test_a_limit_is_obeyed(tmp_path: Path) -> None:
    library = indexed(tmp_path, *MESHES)
    assert len(json_lines(run("duplicates", "--data-dir", library, "--json", "--limit", 1))) == 1


def test_a_table_shows_names_and_the_relation(tmp_path: Path) -> None:
    result = run("duplicates", "--data-dir", indexed(tmp_path, "c", "d"))
    assert result.exit_code == 0
    for word in ("same shape", "c.ply", "d.ply"):
        assert word in result.stdout


def test_a_library_without_duplicates_says_so(tmp_path: Path) -> None:
    library = indexed(tmp_path, "a", "c")
    assert "There are no duplicates." in run("duplicates", "--data-dir", library).stdout
    assert json_lines(run("duplicates", "--data-dir", library, "--json", "--re-posed")) == []


def test_a_library_must_be_there(tmp_path: Path) -> None:
    result = run("duplicates", "--data-dir", tmp_path / "nowhere")
    assert result.exit_code == 1
    assert "there is no library" in plain_line(result)
