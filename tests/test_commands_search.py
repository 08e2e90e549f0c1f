"""`faience search`: ranked answers for files, and plain words for what is wrong."""

from pathlib import Path

import pytest

from tests.commanding import json_lines, make_meshes, make_quick, plain_line, run


@pytest.fixture(autouse=True)
def _quick(monkeypatch: pytest.MonkeyPatch) -> None:
    make_quick(monkeypatch)


@pytest.fixture
def library(tmp_path: Path) -> Path:
    """Return a library of four shapes."""
    make_meshes(tmp_path / "in", 4)
    assert run("index", tmp_path / "in", "--data-dir", tmp_path / "lib").exit_code == 0
    return tmp_path / "lib"


def test_each_query_gets_one_line_in_order(tmp_path: Path, library: Path) -> None:
    queries = make_meshes(tmp_path / "queries", 2)
    result = run("search", *queries, "--data-dir", library, "--limit", 3, "--json")
    lines = json_lines(result)
    assert result.exit_code == 0
    assert [line["query"] for line in lines] == [str(path) for path in queries]
    for number, line in enumerate(lines):
        assert line.keys() == {"query", "method", "results"}
        assert line["method"] == "fused"
        assert [hit["rank"] for hit in line["results"]] == [1, 2, 3]
        assert line["results"][0]["name"] == f"mesh{number}.ply"
        assert line["results"][0].keys() == {"rank", "name", "id", "distance"}
        distances = [hit["distance"] for hit in line["results"]]
        assert distances == sorted(distances)


def test_another_method_can_be_asked_for(tmp_path: Path, library: Path) -> None:
    query = make_meshes(tmp_path / "queries", 1)[0]
    line = json_lines(run("search", query, "--data-dir", library, "--method", "hks", "--json"))[0]
    assert line["method"] == "hks"


def test_a_table_shows_names_and_ids(tmp_path: Path, library: Path) -> None:
    query = make_meshes(tmp_path / "queries", 1)[0]
    result = run("search", query, "--data-dir", library)
    assert "mesh0.ply" in result.stdout
    assert "rank" in result.stdout


def test_one_bad_query_does_not_hide_the_others(tmp_path: Path, library: Path) -> None:
    queries = make_meshes(tmp_path / "queries", 2)
    queries[0].write_bytes(b"")
    result = run("search", *queries, "--data-dir", library, "--json")
    assert [line["query"] for line in json_lines(result)] == [str(queries[1])]
    assert result.exit_code == 1
    assert "(empty)" in result.stderr
    assert "1 of 2 queries could not be answered" in result.stderr


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["nothere.ply"], "there is no file or folder"),
        (["."], "is a folder"),
        (["nothere.ply", "--method", "magic"], "no method is called 'magic'"),
    ],
)
def test_what_is_wrong_is_one_plain_line(library: Path, arguments: list[str], words: str) -> None:
    result = run("search", *arguments, "--data-dir", library)
    assert result.exit_code == 1
    assert words in plain_line(result)


def test_an_empty_or_missing_library_is_one_plain_line(tmp_path: Path) -> None:
    query = make_meshes(tmp_path, 1)[0]
    missing = run("search", query, "--data-dir", tmp_path / "lib")
    assert missing.exit_code == 1
    assert "there is no library" in plain_line(missing)
    assert not (tmp_path / "lib").exists()
    (tmp_path / "lib").mkdir()
    empty = run("search", query, "--data-dir", tmp_path / "lib")
    assert empty.exit_code == 1
    assert "is empty" in plain_line(empty)
