"""`faience key`: a key is shown once, listed without its secret, and revoked for good."""

import signal
from pathlib import Path

import httpx
import pytest

from index.database import make_engine
from index.keys import Keys
from index.scopes import Scope
from service.settings import Settings
from tests.commanding import json_lines, plain_line, run, start
from tests.serving import wait_until


def active_in(folder: Path) -> dict[str, Scope]:
    engine = make_engine(Settings(data_dir=folder).url)
    active = Keys(engine).active()
    engine.dispose()
    return {key.id: key.scope for key in active}


def created(folder: Path, name: str, *options: str) -> dict[str, str]:
    result = run("key", "create", name, *options, "--data-dir", folder, "--json")
    assert result.exit_code == 0, result.output
    (line,) = json_lines(result)
    return line


def test_a_key_can_be_made_before_anything_else_and_allows_what_was_asked(tmp_path: Path) -> None:
    lines = [created(tmp_path / "lib", scope, "--scope", scope) for scope in Scope]
    lines.append(created(tmp_path / "lib", "default"))
    assert [line["scope"] for line in lines] == ["read", "write", "read"]
    assert active_in(tmp_path / "lib") == {line["id"]: line["scope"] for line in lines}


def test_the_secret_is_shown_whole_and_only_once(tmp_path: Path) -> None:
    result = run("key", "create", "loan [red] desk", "--scope", "write", "--data-dir", tmp_path)
    (secret,) = [line.strip() for line in result.stdout.splitlines() if line.strip().startswith("fa_")]
    assert "loan [red] desk" in result.stdout
    for options in ([], ["--json"]):
        listed = run("key", "list", "--data-dir", tmp_path, *options)
        assert secret.split("_")[1] in listed.stdout
        assert "loan [red] desk" in listed.stdout
        assert secret.split("_", 2)[2] not in listed.stdout


def test_a_revoked_key_is_listed_as_such(tmp_path: Path) -> None:
    first, second = created(tmp_path, "first"), created(tmp_path, "second")
    result = run("key", "revoke", first["id"], "--data-dir", tmp_path)
    assert "opens nothing any more" in result.stdout
    assert "last one" not in result.stdout
    lines = json_lines(run("key", "list", "--data-dir", tmp_path, "--json"))
    assert [(line["name"], line["revoked_at"] is None) for line in lines] == [
        ("first", False),
        ("second", True),
    ]
    assert set(active_in(tmp_path)) == {second["id"]}


def test_revoking_the_last_key_says_what_that_means(tmp_path: Path) -> None:
    only = created(tmp_path, "only")
    assert "last one" in run("key", "revoke", only["id"], "--data-dir", tmp_path).stdout
    assert json_lines(run("key", "revoke", only["id"], "--data-dir", tmp_path, "--json"))[0]["revoked_at"]


def test_an_unknown_id_is_one_plain_line(tmp_path: Path) -> None:
    created(tmp_path, "only")
    result = run("key", "revoke", "0123456789", "--data-dir", tmp_path)
    assert result.exit_code == 1
    assert "faience key list" in plain_line(result)


@pytest.mark.parametrize("command", [["list"], ["revoke", "0123456789"]])
def test_where_there_is_no_library_it_is_said_and_none_is_made(tmp_path: Path, command: list[str]) -> None:
    result = run("key", *command, "--data-dir", tmp_path / "lib")
    assert result.exit_code == 1
    assert "no library" in plain_line(result)
    assert not (tmp_path / "lib").exists()


def test_a_library_without_keys_says_how_to_make_one(tmp_path: Path) -> None:
    assert "faience key create" in run("key", "list", "--data-dir", tmp_path).stdout
    assert run("key", "list", "--data-dir", tmp_path, "--json").stdout == ""


def test_a_name_that_no_list_could_show_is_one_plain_line(tmp_path: Path) -> None:
    result = run("key", "create", " ", "--data-dir", tmp_path)
    assert result.exit_code == 1
    assert "printable" in plain_line(result)


def test_an_unknown_scope_is_refused(tmp_path: Path) -> None:
    result = run("key", "create", "x", "--scope", "all", "--data-dir", tmp_path / "lib")
    assert result.exit_code == 2
    assert not (tmp_path / "lib").exists()


def test_a_running_service_follows_and_tells_no_key(tmp_path: Path) -> None:
    with start("serve", "--port", "0", "--workers", "0", "--data-dir", tmp_path) as process:
        assert process.stdout is not None
        address = process.stdout.readline().split("at ")[1].split()[0]

        def status(secret: str | None = None) -> int:
            header = {"authorization": f"Bearer {secret}"} if secret else {}
            return httpx.get(f"{address}/v1/methods", headers=header, timeout=60).status_code

        assert status() == 200  # open, for this machine alone
        made = created(tmp_path, "reader")
        wait_until(lambda: status() == 401)
        assert status(made["key"]) == 200
        run("key", "revoke", made["id"], "--data-dir", tmp_path)
        wait_until(lambda: status(made["key"]) == 401)
        assert status() == 401
        process.send_signal(signal.SIGTERM)
        output = "".join(process.communicate(timeout=120))
    assert made["key"].split("_", 2)[2] not in output
