"""Descriptions of two versions beside each other in the catalogue, and in the indexes."""

from collections.abc import Iterator
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest

from index.errors import LeaseLost, VocabularyChanged
from index.jobs import MAX_ATTEMPTS, Job
from index.methods import METHODS
from index.queue import Queue
from index.searcher import Searcher
from index.shapes import Status
from index.upcoming import Upcoming
from tests.brute_force import METHOD_NAMES, PLAIN, add, agrees, distance, make_blocks
from tests.catalogues import (
    FINGERPRINT,
    HISTOGRAM,
    WORDS,
    Opened,
    add_queued,
    make_vocabulary,
    open_catalogue,
)

pytestmark = pytest.mark.usefixtures("database")  # on SQLite and on PostgreSQL
NEW = "fedcba9876543210"
NEXT = make_vocabulary(2, NEW)
SHAPES = 6


@pytest.fixture
def opened(tmp_path: Path) -> Iterator[Opened]:
    found = open_catalogue(tmp_path)
    for number in range(SHAPES):
        add(found, number)
    yield found
    found.engine.dispose()


def renewal_of(opened: Opened) -> Job:
    """Take a job to describe a shape anew."""
    opened.catalogue.queue_renewals(100)
    job = opened.queue.claim("new", 60, NEW)
    assert job is not None
    assert job.fingerprint == NEW
    return job


def renew(opened: Opened, job: Job) -> None:
    blocks = make_blocks(50 + int(job.shape_id[1:]))
    opened.catalogue.record_renewed(
        job,
        facts={"vertices": 4},
        fingerprint=NEW,
        blocks={name: block for name, block in blocks.items() if name in PLAIN},
        quantised={name: block for name, block in blocks.items() if name not in PLAIN},
        vocabulary_id=NEXT.id,
    )


def upcoming_agrees(searcher: Searcher, opened: Opened, renewed: list[str]) -> bool:
    """Compare answers among what is described anew with brute force."""
    query = make_blocks(99)
    rows = {shape_id: make_blocks(50 + int(shape_id[1:])) for shape_id in renewed}
    expected = {
        name: sorted((distance(METHODS[name], query, blocks), shape_id) for shape_id, blocks in rows.items())
        for name in METHOD_NAMES
    }
    return all(
        searcher.search(name, query, 7, vocabulary_id=NEXT.id)
        == [(shape_id, found) for found, shape_id in expected[name]]
        for name in METHOD_NAMES
    )


def test_both_indexes_agree_with_brute_force_after_each_shape_and_after_the_end(
    opened: Opened, tmp_path: Path
) -> None:
    searcher = Searcher(opened.catalogue, tmp_path / "index")
    upcoming = Searcher(Upcoming(opened.engine), tmp_path / "upcoming")
    opened.catalogue.begin_renewal(NEXT)
    renewed: list[str] = []
    for _ in range(SHAPES):
        assert not opened.catalogue.finish_renewal()
        job = renewal_of(opened)
        renew(opened, job)
        renewed.append(job.shape_id)
        assert agrees(searcher, opened)
        assert upcoming_agrees(upcoming, opened, renewed)
    with pytest.raises(VocabularyChanged):
        searcher.search("fused", make_blocks(1), 1, vocabulary_id=NEXT.id)
    before = opened.catalogue.state()
    assert opened.catalogue.finish_renewal()
    state = opened.catalogue.state()
    assert (state.vocabulary_id, state.next_vocabulary_id, state.epoch) == (NEXT.id, None, before.epoch + 1)
    assert agrees(searcher, opened)
    assert upcoming_agrees(searcher, opened, renewed)
    with pytest.raises(VocabularyChanged):
        upcoming.search("fused", make_blocks(1), 1, vocabulary_id=NEXT.id)
    assert not opened.catalogue.finish_renewal()


def test_uploads_go_before_shapes_that_are_described_anew(opened: Opened) -> None:
    opened.catalogue.begin_renewal(NEXT)
    assert opened.catalogue.queue_renewals(2) == 2
    assert opened.queue.depth() == 0  # of uploads
    add_queued(opened, "late")
    first = opened.queue.claim("new", 60, NEW)
    assert first is not None
    assert (first.shape_id, first.fingerprint) == ("late", None)
    second = opened.queue.claim("new", 60, NEW)
    assert second is not None
    assert second.fingerprint == NEW
    assert opened.catalogue.get(second.shape_id).status == Status.READY
    progress = opened.catalogue.progress()
    assert (progress.queued, progress.processing, progress.held) == (0, 1, {"new": 2})
    opened.queue.give_back(second)
    assert opened.catalogue.get(second.shape_id).status == Status.READY


def test_only_workers_of_that_version_describe_anew(opened: Opened) -> None:
    opened.catalogue.begin_renewal(NEXT)
    opened.catalogue.queue_renewals(100)
    assert opened.queue.claim("old", 60) is None
    assert opened.queue.claim("old", 60, FINGERPRINT) is None
    assert opened.queue.claim("new", 60, NEW) is not None


def test_shapes_are_queued_once_and_some_at_a_time(opened: Opened) -> None:
    assert opened.catalogue.queue_renewals(100) == 0  # nothing was begun
    opened.catalogue.begin_renewal(NEXT)
    opened.catalogue.begin_renewal(NEXT)
    assert [opened.catalogue.queue_renewals(4) for _ in range(3)] == [4, 2, 0]
    renew(opened, renewal_of(opened))
    assert opened.catalogue.queue_renewals(100) == 0


def test_what_is_given_up_counts_as_not_described_anew(opened: Opened) -> None:
    opened.catalogue.begin_renewal(NEXT)
    opened.catalogue.queue_renewals(100)
    later = datetime.now(UTC)
    for _ in range(MAX_ATTEMPTS + 1):
        later += timedelta(hours=1)
        queue = Queue(opened.engine, clock=lambda: later)  # noqa: B023 - used up within this round
        for _ in range(SHAPES):
            queue.claim("dies", 60, NEW)
    progress = opened.catalogue.renewal()
    assert progress is not None
    assert (progress.done, progress.failed, progress.total) == (0, SHAPES, SHAPES)
    assert opened.catalogue.counts()[Status.READY] == SHAPES
    assert opened.catalogue.finish_renewal()
    assert opened.catalogue.counts()[Status.FAILED] == SHAPES
    assert opened.catalogue.get("s0000").error_code == "gave_up"


def test_what_another_worker_has_taken_is_not_recorded(opened: Opened) -> None:
    opened.catalogue.begin_renewal(NEXT)
    job = renewal_of(opened)
    opened.queue.give_back(job)
    with pytest.raises(LeaseLost):
        renew(opened, job)
    with pytest.raises(LeaseLost):
        opened.catalogue.record_not_renewed(job, code="x", detail="y")
    add_queued(opened, "late")
    upload = opened.queue.claim("new", 60, NEW)
    assert upload is not None
    with pytest.raises(LeaseLost, match="about an upload"):
        opened.catalogue.record_not_renewed(upload, code="x", detail="y")


def test_a_still_newer_version_begins_again_and_the_remains_are_forgotten(opened: Opened) -> None:
    opened.catalogue.begin_renewal(NEXT)
    job = renewal_of(opened)
    renew(opened, job)
    lost = renewal_of(opened)
    third = make_vocabulary(3, "0" * 16)
    opened.catalogue.begin_renewal(third)
    with pytest.raises(LeaseLost):
        renew(opened, lost)
    progress = opened.catalogue.renewal()
    assert progress is not None
    assert (progress.fingerprint, progress.done) == (third.fingerprint, 0)
    assert opened.catalogue.left_behind(NEW)
    assert not opened.catalogue.left_behind(FINGERPRINT)
    assert not opened.catalogue.left_behind("unknown")
    outdated = opened.catalogue.outdated(100)
    assert [(shape.id, shape.folders) for shape in outdated] == [(job.shape_id, (None, third.fingerprint))]
    opened.catalogue.forget_earlier([job.shape_id])
    assert opened.catalogue.outdated(100) == []
    assert set(opened.catalogue.some_blocks([job.shape_id], NEXT.id, ["hks-0"])[job.shape_id]) == set()
    assert "hks-0" in opened.catalogue.blocks(job.shape_id, opened.vocabulary_id)


def test_words_learnt_for_the_earlier_descriptions_spare_those_of_the_new(opened: Opened) -> None:
    opened.catalogue.begin_renewal(NEXT)
    job = renewal_of(opened)
    renew(opened, job)
    learnt = make_vocabulary(9)
    opened.catalogue.add_vocabulary(learnt)
    for number in range(SHAPES):
        opened.catalogue.add_quantised(f"s{number:04}", learnt.id, WORDS)
    assert opened.catalogue.activate(learnt.id)
    assert "hks-0" in opened.catalogue.some_blocks([job.shape_id], NEXT.id, ["hks-0"])[job.shape_id]


def test_a_failed_shape_that_is_tried_again_leaves_nothing_of_before(opened: Opened) -> None:
    opened.catalogue.begin_renewal(NEXT)
    for _ in range(SHAPES):
        renew(opened, renewal_of(opened))
    assert opened.catalogue.finish_renewal()
    opened.catalogue.forget_earlier([shape.id for shape in opened.catalogue.outdated(100)])
    third = make_vocabulary(3, "0" * 16)
    opened.catalogue.begin_renewal(third)
    opened.catalogue.queue_renewals(100)
    while (job := opened.queue.claim("newest", 60, third.fingerprint)) is not None:
        opened.catalogue.record_not_renewed(job, code="too_complex", detail="no")
    assert opened.catalogue.finish_renewal()
    opened.catalogue.forget_earlier([shape.id for shape in opened.catalogue.outdated(100)])
    opened.catalogue.retry("s0000")
    job = opened.queue.claim("newest", 60, third.fingerprint)
    assert job is not None
    shape = opened.catalogue.record_ready(
        job,
        facts={},
        fingerprint=third.fingerprint,
        blocks=HISTOGRAM,
        quantised=WORDS,
        vocabulary_id=third.id,
    )
    assert shape.made_in is None
    assert [(shape.id, shape.folders) for shape in opened.catalogue.outdated(9)] == [("s0000", (None,))]
