"""How far the queue is, by hand."""

from collections.abc import Iterator
from datetime import UTC, datetime, timedelta
from functools import partial
from pathlib import Path

import pytest
from sqlalchemy import delete, func, select, update

from index.database import reading, writing
from index.jobs import MAX_ATTEMPTS
from index.queue import Queue
from index.tables import FinishedJobRow, JobRow
from tests.catalogues import Opened, add_queued, add_ready, open_catalogue

pytestmark = pytest.mark.usefixtures("database")  # on SQLite and on PostgreSQL

NOON = datetime(2026, 3, 1, 12, tzinfo=UTC)


@pytest.fixture
def opened(tmp_path: Path) -> Iterator[Opened]:
    opened = open_catalogue(tmp_path)
    yield opened
    opened.engine.dispose()


def finished(opened: Opened, *ago_and_seconds: tuple[float, float]) -> None:
    """Pretend that jobs ended so many seconds before noon, after so many seconds of work."""
    with writing(opened.engine) as session:
        session.execute(delete(FinishedJobRow))
        for ago, seconds in ago_and_seconds:
            moment = NOON - timedelta(seconds=ago)
            session.add(FinishedJobRow(finished_at=moment, seconds=seconds, outcome="ready", worker="w"))


def test_an_empty_queue_that_never_worked_knows_no_speed(opened: Opened) -> None:
    progress = opened.catalogue.progress(NOON)
    assert (progress.queued, progress.held, progress.oldest_queued_at) == (0, {}, None)
    assert (progress.last_minute, progress.last_hour, progress.median_seconds) == (0, 0, None)
    assert progress.expected_seconds == 0


def test_nobody_knows_when_a_queue_ends_that_nobody_works_on(opened: Opened) -> None:
    add_queued(opened, "a")
    finished(opened, (400, 1))  # too long ago
    assert opened.catalogue.progress(NOON).expected_seconds is None


def test_windows_and_medians_are_those_of_the_rows(opened: Opened) -> None:
    finished(opened, (0, 1), (59, 2), (61, 4), (3599, 8), (3601, 100))
    progress = opened.catalogue.progress(NOON)
    assert (progress.last_minute, progress.last_hour) == (2, 4)
    assert progress.median_seconds == 3


def test_the_end_is_expected_at_the_speed_of_the_last_minutes(opened: Opened) -> None:
    for number in range(6):
        add_queued(opened, f"s{number}")
    finished(opened, (0, 2), (18, 2))  # two in the twenty seconds since the first began
    assert opened.catalogue.progress(NOON).expected_seconds == pytest.approx(6 / (2 / 20))


def test_workers_are_told_by_what_they_hold(opened: Opened) -> None:
    queue = Queue(opened.engine, clock=lambda: NOON)
    for number in range(4):
        add_queued(opened, f"s{number}")
    for worker, lease in (("one", 60), ("two", 60), ("one", 60), ("dead", -1)):
        queue.claim(worker, lease)
    progress = opened.catalogue.progress(NOON)
    assert (progress.held, progress.queued) == ({"one": 2, "two": 1}, 1)


def test_the_oldest_is_the_one_that_waits_longest(opened: Opened) -> None:
    for number in range(3):
        add_queued(opened, f"s{number}")
        with writing(opened.engine) as session:
            moment = NOON + timedelta(seconds=number)
            session.execute(update(JobRow).where(JobRow.shape_id == f"s{number}").values(queued_at=moment))
    assert opened.catalogue.progress(NOON).oldest_queued_at == NOON
    assert Queue(opened.engine, clock=lambda: NOON).claim("w", 60) is not None
    assert opened.catalogue.progress(NOON).oldest_queued_at == NOON + timedelta(seconds=1)


def test_every_job_that_ends_is_noted_with_its_outcome_and_time(opened: Opened) -> None:
    add_ready(opened, "a")
    add_queued(opened, "b")
    job = opened.queue.claim("w", 60)
    assert job is not None
    opened.catalogue.record_failed(job, code="no_faces", detail="none")
    with reading(opened.engine) as session:
        rows = session.scalars(select(FinishedJobRow).order_by(FinishedJobRow.id)).all()
        assert [(row.outcome, row.worker) for row in rows] == [("ready", "test"), ("no_faces", "w")]
        assert all(0 <= row.seconds < 60 for row in rows)
    assert opened.catalogue.progress().last_minute == 2


def test_a_job_that_is_given_up_has_ended_too(opened: Opened) -> None:
    moments = (NOON + timedelta(seconds=61 * number) for number in range(MAX_ATTEMPTS + 1))
    queue = Queue(opened.engine, clock=partial(next, moments))
    add_queued(opened, "killer")
    for _ in range(MAX_ATTEMPTS + 1):  # the last finds that enough was tried
        queue.claim("w", 60)
    with reading(opened.engine) as session:
        rows = session.scalars(select(FinishedJobRow)).all()
        assert [(row.outcome, row.worker, row.seconds) for row in rows] == [("gave_up", "w", 61)]


def test_what_ended_long_ago_is_forgotten(opened: Opened) -> None:
    finished(opened, *((float(number), 1.0) for number in range(50)))  # years before the next
    add_ready(opened, "a")
    with reading(opened.engine) as session:
        assert session.scalars(select(func.count()).select_from(FinishedJobRow)).one() == 1
