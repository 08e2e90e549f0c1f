"""The command line in tests: quick descriptions, small folders, lines of JSON."""

import json
import os
import subprocess
import sys
from functools import partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from typer.testing import CliRunner, Result

from service.commands import opening, searching
from service.commands.main import app
from service.jobs.workers import Worker
from service.retrieval import search_upload
from tests.fakes import coloured_triangle, describe_quickly
from tests.serving import open_fake_library


def make_quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """Replace the descriptions by fakes that need no eigenproblem."""
    monkeypatch.setattr(opening, "Worker", partial(Worker, describe=describe_quickly))
    monkeypatch.setattr(searching, "search_upload", partial(search_upload, describe=describe_quickly))
    monkeypatch.setattr(opening, "Library", SimpleNamespace(open=open_fake_library))
    monkeypatch.setenv("FAIENCE_POLL_SECONDS", "0.05")


HERE = Path(__file__).parent
MAIN = "from service.commands.main import main; main()"


def start(*arguments: str | Path | int, script: str = MAIN) -> subprocess.Popen[str]:
    """Start a command in a process of its own; its output and errors are pipes."""
    environment = {**os.environ, "PYTHONPATH": str(HERE.parent)}
    return subprocess.Popen(
        [sys.executable, "-c", script, *map(str, arguments)],
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def run(*arguments: str | Path | int) -> Result:
    """Run a command in this process."""
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def json_lines(result: Result) -> list[dict[str, Any]]:
    """Return what a command printed with --json."""
    return [json.loads(line) for line in result.stdout.splitlines()]


def plain_line(result: Result) -> str:
    """Return the one line on stderr; there must be no more."""
    lines = [line for line in result.stderr.splitlines() if line.startswith("faience: ")]
    assert len(lines) == 1
    assert "Traceback" not in result.stderr
    return lines[0]


def make_meshes(folder: Path, count: int) -> list[Path]:
    """Write as many small meshes of different colours."""
    folder.mkdir(parents=True, exist_ok=True)
    paths = [folder / f"mesh{number}.ply" for number in range(count)]
    for number, path in enumerate(paths):
        path.write_bytes(coloured_triangle(red=20 + 30 * number))
    return paths
