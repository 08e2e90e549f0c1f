"""Killed again and again, the service keeps what it promised."""

from pathlib import Path

import pytest

from soak.crashes import TARGETS, kills_of, run
from tests.databases import DATABASES
from tests.storages import BUCKET

KILLS = 12


def test_kills_at_any_moment_lose_nothing_double_nothing_and_leave_nothing(
    database: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest
) -> None:
    if database == "postgresql":  # with files in a bucket, as where there are several machines
        request.getfixturevalue("object_server")
        monkeypatch.setenv("FAIENCE_DATABASE_URL", DATABASES.url(tmp_path))
        monkeypatch.setenv("FAIENCE_STORAGE_URL", f"s3://{BUCKET}/crashes")
    done: list[int] = []
    figures = run(tmp_path, KILLS, seed=2011, report=done.append)
    assert figures.broken == []
    assert kills_of(figures.harm) == done[-1] == KILLS
    assert all(figures.harm[target] > 0 for target in TARGETS)
    assert figures.acknowledged > 0
    assert figures.answers["similar 200"] > 0
