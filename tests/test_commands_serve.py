"""`faience serve` and `faience worker`: what is wrong is said before anything starts."""

import signal
import socket
import sqlite3
from pathlib import Path

import httpx
import pytest

from service import server
from service.commands.failures import CommandFailed
from service.commands.serve import check_address
from service.settings import Settings
from tests.commanding import plain_line, run, start


def test_a_port_in_use_is_one_plain_line(tmp_path: Path) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        result = run("serve", "--port", port, "--data-dir", tmp_path / "lib")
    assert result.exit_code == 1
    assert "already in use" in plain_line(result)
    assert not (tmp_path / "lib").exists()


def test_a_free_port_is_fine() -> None:
    check_address("127.0.0.1", 0)


def test_an_address_of_another_machine_is_refused() -> None:
    with pytest.raises(CommandFailed, match="cannot listen"):
        check_address("192.0.2.1", 8000)


def test_listening_to_all_without_a_key_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("FAIENCE_API_KEYS", raising=False)
    result = run("serve", "--host", "0.0.0.0", "--port", 0, "--data-dir", tmp_path / "lib")  # noqa: S104 - refused
    assert result.exit_code == 1
    assert "without a key" in plain_line(result)


def test_listening_to_all_is_refused_before_a_library_is_made_and_goes_with_a_key_of_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("FAIENCE_API_KEYS", raising=False)
    started: list[Settings] = []
    monkeypatch.setattr(server, "run_server", lambda settings, *_: started.append(settings))
    folder = tmp_path / "lib"
    arguments = "serve", "--host", "0.0.0.0", "--port", 0, "--data-dir", folder  # noqa: S104 - not started
    result = run(*arguments)
    assert (result.exit_code, started) == (1, [])
    assert "faience key create" in plain_line(result)
    assert not folder.exists()
    run("key", "create", "loan desk", "--data-dir", folder)
    assert run(*arguments).exit_code == 0
    assert [settings.data_dir for settings in started] == [folder]


@pytest.mark.parametrize("command", ["serve", "worker"])
def test_a_library_of_a_newer_version_is_one_plain_line(tmp_path: Path, command: str) -> None:
    run("learn-vocabulary", "--data-dir", _made(tmp_path / "lib"))
    with sqlite3.connect(tmp_path / "lib" / "catalogue.sqlite3") as database:
        database.execute("UPDATE alembic_version SET version_num = 'ffff'")
    database.close()
    options = ["--port", 0] if command == "serve" else []
    result = run(command, *map(str, options), "--data-dir", tmp_path / "lib")
    assert result.exit_code == 1
    assert "newer version" in plain_line(result)


@pytest.mark.parametrize("command", ["serve", "worker", "index"])
def test_a_file_in_place_of_the_library_is_one_plain_line(tmp_path: Path, command: str) -> None:
    (tmp_path / "lib").write_text("a file")
    options = {"serve": ["--port", "0"], "worker": [], "index": [str(_mesh(tmp_path))]}[command]
    result = run(command, *options, "--data-dir", tmp_path / "lib")
    assert result.exit_code == 1
    assert "exists" in plain_line(result)


def test_a_setting_that_is_no_number_is_one_plain_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("FAIENCE_JOB_SECONDS", "soon")
    result = run("worker", "--data-dir", tmp_path / "lib")
    assert result.exit_code == 1
    assert "job_seconds" in plain_line(result)


def test_the_service_starts_says_where_and_stops(tmp_path: Path) -> None:
    with start("serve", "--port", "0", "--workers", "0", "--data-dir", tmp_path / "lib") as process:
        assert process.stdout is not None
        address = process.stdout.readline().split("at ")[1].split()[0]
        assert httpx.get(f"{address}/livez", timeout=60).status_code == 200
        process.send_signal(signal.SIGTERM)
        errors = process.communicate(timeout=120)[1]
    assert process.returncode == 0
    assert "Traceback" not in errors


def test_a_worker_starts_and_stops(tmp_path: Path) -> None:
    with start("worker", "--workers", "1", "--json", "--data-dir", tmp_path / "lib") as process:
        assert process.stdout is not None
        assert "Working on the queue" in process.stdout.readline()
        process.send_signal(signal.SIGINT)
        errors = process.communicate(timeout=120)[1]
    assert process.returncode == 0
    assert "Traceback" not in errors


def _made(folder: Path) -> Path:
    folder.mkdir()
    return folder


def _mesh(folder: Path) -> Path:
    path = folder / "a.ply"
    path.write_bytes(b"ply\n")
    return path
