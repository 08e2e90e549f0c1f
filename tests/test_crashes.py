"""Killed again and again, the service keeps what it promised."""

from pathlib import Path

from soak.crashes import TARGETS, kills_of, run

KILLS = 12


def test_kills_at_any_moment_lose_nothing_double_nothing_and_leave_nothing(tmp_path: Path) -> None:
    done: list[int] = []
    figures = run(tmp_path, KILLS, seed=2011, report=done.append)
    assert figures.broken == []
    assert kills_of(figures.harm) == done[-1] == KILLS
    assert all(figures.harm[target] > 0 for target in TARGETS)
    assert figures.acknowledged > 0
    assert figures.answers["similar 200"] > 0
