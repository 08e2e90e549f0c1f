"""A claim changes a job, its shape and the revision together, or nothing."""

from collections.abc import Iterator
from datetime import timedelta
from pathlib import Path

import pytest

from index.claiming import Kind, any_waits, take_oldest
from index.database import writing
from index.queue import MAX_ATTEMPTS
from index.revisions import now
from index.shapes import Status
from tests.catalogues import Opened, add_queued, open_catalogue

pytestmark = pytest.mark.usefixtures("database")  # on SQLite and on PostgreSQL


@pytest.fixture
def opened(tmp_path: Path) -> Iterator[Opened]:
    made = open_catalogue(tmp_path)
    yield made
    made.engine.dispose()


def test_a_claim_is_a_change_that_replicas_see(opened: Opened) -> None:
    add_queued(opened, "a")
    before = opened.catalogue.revision()
    assert opened.queue.claim("w", 60) is not None
    assert opened.catalogue.changes_since(before).changed == ("a",)
    assert opened.catalogue.get("a").revision == opened.catalogue.revision() == before + 1
    assert opened.catalogue.get("a").status == Status.PROCESSING


def test_a_claim_that_came_too_late_changes_nothing(opened: Opened) -> None:
    before = opened.catalogue.revision()
    moment = now()
    until = moment + timedelta(seconds=60)
    with writing(opened.engine) as session:
        assert not any_waits(session, moment, None)
        assert take_oldest(session, Kind.UPLOAD, moment, "late", until, None) is None
    assert opened.catalogue.revision() == before


def test_a_job_that_was_tried_too_often_is_told_and_not_taken(opened: Opened) -> None:
    add_queued(opened, "killer")
    for _ in range(MAX_ATTEMPTS):
        assert opened.queue.claim("w", -1) is not None  # a lease that is over at once
    before = opened.catalogue.revision()
    moment = now()
    with writing(opened.engine) as session:
        assert any_waits(session, moment, None)
        job = take_oldest(session, Kind.UPLOAD, moment, "w", moment + timedelta(seconds=60), None)
    assert job is not None
    assert (job.shape_id, job.attempts) == ("killer", MAX_ATTEMPTS + 1)
    assert opened.catalogue.revision() == before
    with writing(opened.engine) as session:  # still free
        assert any_waits(session, moment, None)


def test_what_was_tried_too_often_is_given_up_although_others_wait(opened: Opened) -> None:
    add_queued(opened, "killer")
    for _ in range(MAX_ATTEMPTS):
        assert opened.queue.claim("w", -1) is not None
    add_queued(opened, "good")
    add_queued(opened, "better")
    job = opened.queue.claim("w", 60)
    assert job is not None
    assert job.shape_id == "good"
    assert opened.catalogue.get("killer").error_code == "gave_up"
