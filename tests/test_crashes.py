"""Killed again and again, the service keeps what it promised."""

import contextlib
from pathlib import Path

import pytest

from soak.crashes import MACHINE, TARGETS, kills_of, run
from soak.processes import Command
from tests.clusters import machines
from tests.databases import DATABASES
from tests.storages import BUCKET

KILLS = 6  # `make soak` kills a hundred times, and sends more meanwhile
PACE = 2.0  # seconds between uploads


def test_kills_at_any_moment_lose_nothing_double_nothing_and_leave_nothing(
    database: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest
) -> None:
    done: list[int] = []
    with contextlib.ExitStack() as stack:
        computers: tuple[Command, ...] = ()
        if database == "postgresql":  # with files in a bucket and a cluster, as on several machines
            request.getfixturevalue("object_server")
            cluster = stack.enter_context(machines(tmp_path, 1, 1))
            computers = cluster.computers
            monkeypatch.setenv("FAIENCE_DATABASE_URL", DATABASES.url(tmp_path))
            monkeypatch.setenv("FAIENCE_STORAGE_URL", f"s3://{BUCKET}/crashes")
            monkeypatch.setenv("FAIENCE_CLUSTER", cluster.address)
        figures = run(tmp_path, KILLS, seed=2011, report=done.append, machines=computers, pace=PACE)
    assert figures.broken == []
    assert kills_of(figures.harm) == done[-1] == KILLS
    assert all(figures.harm[target] > 0 for target in (*TARGETS, *([MACHINE] if computers else [])))
    assert figures.acknowledged > 0
    assert figures.answers["similar 200"] > 0
