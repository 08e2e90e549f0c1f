"""`faience webhook`: added, tried, listed, removed."""

from pathlib import Path

from soak.processes import free_port
from tests.commanding import json_lines, plain_line, run
from tests.listening import receiving


def test_a_webhook_from_its_first_message_to_its_last(tmp_path: Path) -> None:
    with receiving() as receiver:
        added = run("webhook", "add", receiver.url, "--data-dir", tmp_path, "--json")
        (line,) = json_lines(added)
        assert line["secret"].startswith("whsec_")
        tried = run("webhook", "test", line["id"], "--data-dir", tmp_path)
        assert "took the message" in tried.stdout
        assert [heard.json["type"] for heard in receiver.heard] == ["ping"]
    listed = run("webhook", "list", "--data-dir", tmp_path)
    assert receiver.url in listed.stdout.replace("\n", "")
    assert line["secret"] not in listed.stdout
    assert run("webhook", "remove", line["id"], "--data-dir", tmp_path).exit_code == 0
    assert "Nobody is told" in run("webhook", "list", "--data-dir", tmp_path).stdout


def test_who_does_not_listen_is_named(tmp_path: Path) -> None:
    url = f"http://127.0.0.1:{free_port()}/x"
    (line,) = json_lines(run("webhook", "add", url, "--data-dir", tmp_path, "--json"))
    result = run("webhook", "test", line["id"], "--data-dir", tmp_path)
    assert result.exit_code == 1
    assert url in plain_line(result)


def test_mistakes_are_told_in_one_line(tmp_path: Path) -> None:
    assert "https://" in plain_line(run("webhook", "add", "library", "--data-dir", tmp_path))
    assert "webhook list" in plain_line(run("webhook", "remove", "x", "--data-dir", tmp_path))
    assert "webhook add" in plain_line(run("webhook", "list", "--data-dir", tmp_path / "none"))
