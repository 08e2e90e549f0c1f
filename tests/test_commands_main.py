"""The `faience` command itself: help, version, wrong options, and everything once for real."""

import json
from pathlib import Path

from tests.commanding import make_meshes, run, start


def _run_for_real(*arguments: str | Path) -> tuple[int, str, str]:
    """Return the exit code, stdout and stderr of a process."""
    with start(*arguments) as process:
        output, errors = process.communicate()
    return process.returncode, output, errors


def test_help_names_every_command() -> None:
    result = run("--help")
    assert result.exit_code == 0
    for command in ("serve", "worker", "index", "search", "learn-vocabulary"):
        assert command in result.stdout


def test_the_version_is_told() -> None:
    assert run("--version").stdout.startswith("faience ")


def test_a_wrong_option_is_one_plain_line() -> None:
    for arguments in (["--nonsense"], ["index"], ["search", "a.ply", "--limit", "x"], ["dance"]):
        code, _, errors = _run_for_real(*arguments)
        assert code == 2
        assert errors.startswith("faience: ")
        assert len(errors.splitlines()) == 1


def test_real_meshes_are_indexed_and_found(tmp_path: Path) -> None:
    paths = make_meshes(tmp_path / "in", 2)
    code, output, errors = _run_for_real("index", tmp_path / "in", "--data-dir", tmp_path / "lib", "--json")
    assert code == 0, errors
    assert json.loads(output.splitlines()[-1])["accepted"] == 2
    code, output, errors = _run_for_real("search", paths[1], "--data-dir", tmp_path / "lib", "--json")
    assert code == 0, errors
    first = json.loads(output)["results"][0]
    assert first["name"] == "mesh1.ply"
    assert first["distance"] < 1e-5
