"""docker-compose.yml starts what there is: commands, settings, services and secrets that exist."""

import re
from pathlib import Path
from typing import Any

import pytest
import typer
import yaml

from service.commands.main import app
from service.settings import Settings

ROOT = Path(__file__).parents[1]
FILE: dict[str, Any] = yaml.safe_load((ROOT / "docker-compose.yml").read_text())
SERVICES: dict[str, dict[str, Any]] = FILE["services"]
CLUSTER = {"api-1", "api-2", "balancer", "bucket", "compute", "postgres", "s3", "scheduler", "worker"}


def in_profile(name: str) -> set[str]:
    return {service for service, said in SERVICES.items() if said["profiles"] == [name]}


def test_without_a_word_there_is_one_service_and_the_cluster_is_asked_for() -> None:
    assert (ROOT / ".env").read_text().splitlines()[-1] == "COMPOSE_PROFILES=default"
    assert in_profile("default") == {"faience"}
    assert in_profile("cluster") == CLUSTER
    assert {name: SERVICES[name]["deploy"]["replicas"] for name in ("worker", "compute")} == {
        "worker": 2,
        "compute": 2,
    }


@pytest.mark.parametrize(
    "words", [said["command"] for said in SERVICES.values() if said.get("command", [""])[0] == "faience"]
)
def test_every_command_is_one_of_ours(words: list[str]) -> None:
    command = typer.main.get_command(app)
    with command.make_context("faience", words[1:2], resilient_parsing=True) as context:
        name, sub, rest = command.resolve_command(context, words[1:])  # type: ignore[attr-defined] # a group
        assert (name, sub is not None) == (words[1], True)
        sub.make_context(name, rest, parent=context)  # raises for an option that it does not have


def test_every_setting_is_one_of_ours() -> None:
    for name, said in SERVICES.items():
        for variable, value in said.get("environment", {}).items():
            if variable.startswith("FAIENCE_"):
                field = variable.removeprefix("FAIENCE_").lower()
                assert field in Settings.model_fields, f"{name}: {variable}"
                assert isinstance(value, str)


def test_whom_a_service_waits_for_is_there_and_can_tell_its_health() -> None:
    for name, said in SERVICES.items():
        for other, how in said.get("depends_on", {}).items():
            assert SERVICES[other]["profiles"] == said["profiles"], f"{name} waits for {other}"
            if how["condition"] == "service_healthy":
                ours = SERVICES[other].get("image") == "faience"  # the image itself has a check
                assert ours or "test" in SERVICES[other]["healthcheck"], f"{other} never tells"


def test_every_host_that_an_address_names_is_a_service() -> None:
    named = set(
        re.findall(r"(?:@|//)([a-z0-9-]+)(?::\d+|/faience)", (ROOT / "docker-compose.yml").read_text())
    )
    assert named >= {"postgres", "scheduler", "s3"}
    assert named - {"faience"} <= set(SERVICES)  # faience is the bucket


def test_nothing_is_open_to_other_machines_and_no_secret_has_a_default() -> None:
    for said in SERVICES.values():
        assert all(port.startswith("127.0.0.1:") for port in said.get("ports", []))
    for secret in ("FAIENCE_API_KEYS", "POSTGRES_PASSWORD", "S3_SECRET"):
        defaults = re.findall(rf"\${{{secret}:-([^}}]*)}}", (ROOT / "docker-compose.yml").read_text())
        assert set(defaults) <= {""}


def test_images_are_pinned_and_ours_takes_every_package() -> None:
    for said in SERVICES.values():
        assert said["image"] == "faience" or re.search(r":v?\d+\.\d+", said["image"])
    recipe = (ROOT / "Dockerfile").read_text()
    assert re.search(r"python:3\.\d+\.\d+-slim", recipe)
    assert {"worker", "index", "service"} == set(re.findall(r"COPY (\w+) \1", recipe))
    assert "--constraint requirements.lock" in recipe
    assert "USER faience" in recipe
