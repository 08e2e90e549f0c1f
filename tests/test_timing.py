"""Where a job's time went is known, and nothing else changes by it."""

import pytest

from service.jobs.timing import Stage, timed, timing
from worker.stages import observed, stage


def two_stages(value: int) -> int:
    with stage("read"):
        pass
    with stage("spectrum"):
        return value


def test_stages_come_back_with_the_value_in_their_order() -> None:
    found = timed(two_stages, 3)
    assert found.value == 3
    assert [each.name for each in found.stages] == ["read", "spectrum"]
    assert all(each.seconds >= 0 and each.began > 1e9 for each in found.stages)


def test_nobody_listens_afterwards() -> None:
    heard = timed(two_stages, 3).stages
    two_stages(4)
    assert len(heard) == 2


def test_a_stage_that_fails_is_timed_too() -> None:
    stages: list[Stage] = []
    with pytest.raises(KeyError), timing("recording", stages):
        raise KeyError
    assert [each.name for each in stages] == ["recording"]


def test_an_observer_hears_of_its_own_block_alone() -> None:
    stages: list[Stage] = []
    with observed(lambda name: timing(name, stages)):
        two_stages(1)
    two_stages(2)
    assert len(stages) == 2
