"""What a worker tells becomes numbers and lines."""

import json
import logging
from dataclasses import replace
from datetime import UTC, datetime, timedelta

import pytest

from index.errors import LeaseLost, ShapeNotFound
from index.jobs import Job
from service.jobs.ended import EndedJob
from service.jobs.timing import Stage
from service.watching.jobs import JobsSeen
from service.watching.logs import JsonLines
from service.watching.metrics import Metrics
from service.watching.spans import Spans

BEGAN = datetime(2026, 1, 1, tzinfo=UTC)
JOB = Job(
    id=7,
    shape_id="s",
    queued_at=BEGAN,
    attempts=1,
    lease_until=BEGAN,
    worker="w",
    token="t",  # noqa: S106 - of no lock
)
STAGES = (
    Stage(name="spectrum", began=1.0, seconds=2.0),
    Stage(name="recording", began=5.0, seconds=0.25),
    Stage(name="spectrum", began=6.0, seconds=1.0),
)
ENDED = EndedJob(
    job=JOB, outcome="ready", claimed_at=BEGAN, ended_at=BEGAN + timedelta(seconds=4), stages=STAGES
)


def test_stages_are_summed_within_a_job_and_counted_once() -> None:
    metrics = Metrics()
    JobsSeen(metrics, Spans()).ended(ENDED)
    lines = metrics.text().decode().splitlines()
    assert 'faience_job_stage_seconds_sum{stage="spectrum"} 3.0' in lines
    assert 'faience_job_stage_seconds_count{stage="spectrum"} 1.0' in lines
    assert 'faience_job_stage_seconds_sum{stage="recording"} 0.25' in lines


def test_waits_are_counted_from_acceptance_where_that_is_known() -> None:
    metrics = Metrics()
    seen = JobsSeen(metrics, Spans())
    seen.claimed(JOB)
    seen.claimed(replace(JOB, queued_at=None))
    (wait,) = (each for each in metrics.collect() if each.name == "faience_job_wait_seconds")
    values = {sample.name: sample.value for sample in wait.samples}
    assert values["faience_job_wait_seconds_count"] == 1
    assert values["faience_job_wait_seconds_sum"] > 0


def test_only_leases_that_ran_out_count_as_lost() -> None:
    metrics = Metrics()
    seen = JobsSeen(metrics, Spans())
    seen.lost(JOB, LeaseLost("late"))
    seen.lost(JOB, ShapeNotFound("removed"))
    assert "faience_leases_lost_total 1.0" in metrics.text().decode()


@pytest.mark.parametrize("lines", [True, False])
def test_each_job_has_a_line_where_lines_are_wanted(lines: bool, caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level(logging.INFO):
        JobsSeen(Metrics(), Spans(), lines=lines).ended(ENDED)
    assert len(caplog.records) == int(lines)
    for record in caplog.records:
        line = json.loads(JsonLines().format(record))
        assert (line["outcome"], line["ms"]) == ("ready", 4000.0)
        assert line["stages"] == {"spectrum": 3.0, "recording": 0.25}
