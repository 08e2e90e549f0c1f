"""A wrong address of a cluster is refused in words, before anything is started."""

from pathlib import Path

import pytest
from pydantic import ValidationError

from service.settings import Settings
from tests.commanding import plain_line, run


@pytest.mark.parametrize("address", ["tcp://scheduler:8786", "tls://10.0.0.1:1", "tcp://[::1]:8786"])
def test_an_address_of_a_scheduler_is_taken(address: str) -> None:
    assert Settings(cluster=address).cluster == address


@pytest.mark.parametrize(
    "address",
    [
        "",
        "scheduler:8786",
        "http://scheduler:8786",
        "tcp://scheduler",
        "tcp://:8786",
        "tcp://a:b",
        "tcp://a:99999",
        "tcp://a:1/x",
    ],
)
def test_anything_else_is_refused(address: str) -> None:
    with pytest.raises(ValidationError, match=r"as in tcp://scheduler:8786"):
        Settings(cluster=address)


@pytest.mark.parametrize("command", ["worker", "index", "compute"])
def test_commands_refuse_it_in_one_line(command: str, tmp_path: Path) -> None:
    mesh = tmp_path / "a.ply"
    mesh.touch()
    arguments: list[str | Path] = [mesh, "--data-dir", tmp_path / "library"] if command == "index" else []
    result = run(command, "--cluster", "scheduler", *arguments)
    assert result.exit_code == 1
    assert "as in tcp://scheduler:8786" in plain_line(result)
    assert not (tmp_path / "library").exists()
