"""A result is stored once, by the worker that holds the job."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from index.errors import LeaseLost
from index.jobs import Job
from index.shapes import Status
from service.intake.submissions import receive_paths
from service.jobs.recording import record_description
from service.library import Library
from service.retrieval import accept_upload, remove_shape
from service.storage import PREVIEW, SIGNATURES, THUMBNAIL, load_signatures
from tests.fakes import coloured_triangle, describe_quickly
from tests.serving import open_fake_library, settings_for
from worker.describe import Description

pytestmark = pytest.mark.usefixtures("kept")  # on SQLite and on PostgreSQL, and with files in a bucket


@pytest.fixture
def library(tmp_path: Path) -> Iterator[Library]:
    opened = open_fake_library(settings_for(tmp_path / "library"))
    yield opened
    opened.close()


@pytest.fixture
def described(library: Library) -> tuple[Job, Description]:
    path = library.incoming.folder / "a.ply"
    path.write_bytes(coloured_triangle())
    accept_upload(library, receive_paths({"a.ply": path}))
    job = library.queue.claim("test", 0.0)
    assert job is not None
    return job, describe_quickly({"a.ply": path.read_bytes()}, False, library.parameters, library.limits)


def test_a_description_makes_the_shape_ready_with_its_files(
    library: Library, described: tuple[Job, Description]
) -> None:
    job, description = described
    shape = record_description(library, job, description)
    assert shape.status == Status.READY
    assert shape.facts is not None
    assert shape.facts["faces"] == 2
    kept = {key.rpartition("/")[2] for key in library.files.keys(f"shapes/{shape.id}")}
    assert kept == {THUMBNAIL, PREVIEW, SIGNATURES}
    signatures = load_signatures(library.files, shape.id)
    assert set(signatures) == set(description.signatures)
    assert {array.dtype.name for array in signatures.values()} == {"float32"}


def test_a_worker_that_lost_its_lease_to_another_stores_nothing(
    library: Library, described: tuple[Job, Description]
) -> None:
    job, description = described
    other = library.queue.claim("other", 60)
    assert other is not None
    with pytest.raises(LeaseLost):
        record_description(library, job, description)
    assert library.catalogue.get(job.shape_id).status == Status.PROCESSING
    assert record_description(library, other, description).status == Status.READY


def test_a_removed_shape_leaves_no_files(library: Library, described: tuple[Job, Description]) -> None:
    job, description = described
    remove_shape(library, job.shape_id)
    with pytest.raises(LeaseLost):
        record_description(library, job, description)
    assert list(library.files.keys()) == []
