from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from index.errors import BadBlock, FingerprintMismatch, LeaseLost, UnknownVocabulary, VocabularyChanged
from index.jobs import Job
from index.packing import rounded
from index.shapes import Shape, Status
from tests.catalogues import (
    FINGERPRINT,
    HISTOGRAM,
    WORDS,
    Opened,
    add_queued,
    add_ready,
    make_vocabulary,
    open_catalogue,
)

pytestmark = pytest.mark.usefixtures("database")  # on SQLite and on PostgreSQL


@pytest.fixture
def opened(tmp_path: Path) -> Iterator[Opened]:
    opened = open_catalogue(tmp_path)
    yield opened
    opened.engine.dispose()


@pytest.fixture
def job(opened: Opened) -> Job:
    add_queued(opened, "a")
    job = opened.queue.claim("w", 60)
    assert job is not None
    return job


def record(opened: Opened, job: Job, **other: Any) -> Shape:
    told: Mapping[str, Any] = {
        "facts": {"vertices": 3, "warnings": ["odd"]},
        "fingerprint": FINGERPRINT,
        "blocks": HISTOGRAM,
        "quantised": WORDS,
        "vocabulary_id": opened.vocabulary_id,
        **other,
    }
    return opened.catalogue.record_ready(job, **told)


def test_a_description_makes_a_shape_ready_and_ends_its_job(opened: Opened, job: Job) -> None:
    shape = record(opened, job)
    assert shape == opened.catalogue.get("a")
    assert (shape.status, shape.facts) == (Status.READY, {"vertices": 3, "warnings": ["odd"]})
    assert opened.queue.depth() == 0
    stored = opened.catalogue.blocks("a", opened.vocabulary_id)
    assert {name: block.tolist() for name, block in stored.items()} == {
        "colour-histogram": rounded("colour-histogram", np.array([0.5, 0, 0.5], np.float32)).tolist(),
        "hks-0": [0.25, 0.75],
    }


def test_a_result_is_stored_once(opened: Opened, job: Job) -> None:
    record(opened, job)
    revision = opened.catalogue.revision()
    with pytest.raises(LeaseLost):
        record(opened, job)
    with pytest.raises(LeaseLost):
        opened.catalogue.record_failed(job, code="late", detail="")
    assert opened.catalogue.revision() == revision
    assert opened.catalogue.get("a").status == Status.READY


def test_a_failure_is_told_with_its_reason(opened: Opened, job: Job) -> None:
    shape = opened.catalogue.record_failed(job, code="truncated", detail="12 of 15 faces")
    assert (shape.status, shape.error_code, shape.error_detail) == (
        Status.FAILED,
        "truncated",
        "12 of 15 faces",
    )
    assert shape.facts is None
    assert opened.queue.depth() == 0


@pytest.mark.parametrize(
    ("other", "error"),
    [
        ({"fingerprint": "another"}, FingerprintMismatch),
        ({"vocabulary_id": "v-unknown"}, UnknownVocabulary),
        ({"blocks": {"colour-histogram": [np.nan, 0, 0]}}, BadBlock),
        ({"quantised": {"hks-0": [[0.5]]}}, BadBlock),
        ({"quantised": {}}, BadBlock),
    ],
)
def test_a_description_that_does_not_fit_changes_nothing(
    opened: Opened, job: Job, other: dict[str, Any], error: type[Exception]
) -> None:
    before = opened.catalogue.get("a")
    with pytest.raises(error):
        record(opened, job, **other)
    assert opened.catalogue.get("a") == before
    assert record(opened, job).status == Status.READY  # the job is still the worker's


@pytest.mark.parametrize("other", [{"blocks": {"colour-histogram": [1, 0]}}, {"quantised": {"hks-0": [1]}}])
def test_a_block_of_another_length_than_the_others_is_refused(opened: Opened, other: dict[str, Any]) -> None:
    add_ready(opened, "first")
    add_queued(opened, "second")
    job = opened.queue.claim("w", 60)
    assert job is not None
    with pytest.raises(FingerprintMismatch, match="numbers"):
        record(opened, job, **other)
    assert record(opened, job).status == Status.READY


def test_a_result_in_the_words_of_yesterday_is_sent_back(opened: Opened, job: Job) -> None:
    new = make_vocabulary(2)
    opened.catalogue.add_vocabulary(new)
    with pytest.raises(VocabularyChanged):
        record(opened, job, vocabulary_id=new.id)
    assert opened.catalogue.activate(new.id)
    with pytest.raises(VocabularyChanged):
        record(opened, job)
    assert record(opened, job, vocabulary_id=new.id).status == Status.READY
