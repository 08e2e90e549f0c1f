"""Use cases keep their promises without HTTP."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from index.errors import CatalogueBusy, ShapeNotFound
from index.shapes import Status
from service.intake.submissions import Submission, receive_paths
from service.library import Library
from service.retrieval import accept_upload, change_shape, remove_shape
from tests.fakes import coloured_triangle
from tests.serving import open_fake_library, settings_for
from worker.errors import MeshError

pytestmark = pytest.mark.usefixtures("kept")  # on SQLite and on PostgreSQL, and with files in a bucket


@pytest.fixture
def library(tmp_path: Path) -> Iterator[Library]:
    opened = open_fake_library(settings_for(tmp_path / "library"))
    yield opened
    opened.close()


@pytest.fixture
def submission(tmp_path: Path) -> Submission:
    path = tmp_path / "sent"
    path.write_bytes(coloured_triangle())
    return receive_paths({"a.ply": path}, metadata={"a": 1})


def fail_next(library: Library) -> None:
    job = library.queue.claim("test", 60)
    assert job is not None
    library.catalogue.record_failed(job, code="no_faces", detail="none")


def test_the_files_are_durable_before_the_row_and_the_row_comes_with_its_job(
    library: Library, submission: Submission
) -> None:
    shape, new = accept_upload(library, submission)
    assert new
    assert [library.files.get(file.key) for file in shape.files] == [coloured_triangle()]
    job = library.queue.claim("test", 60)
    assert job is not None
    assert job.shape_id == shape.id


def test_a_row_that_cannot_be_written_leaves_no_files(
    library: Library, submission: Submission, monkeypatch: pytest.MonkeyPatch
) -> None:
    def busy(**_: object) -> None:
        assert list(library.files.keys("uploads"))  # they were durable before
        raise CatalogueBusy("locked")

    with monkeypatch.context() as broken:
        broken.setattr(library.catalogue, "accept", busy)
        with pytest.raises(CatalogueBusy):
            accept_upload(library, submission)
    assert list(library.files.keys("uploads")) == []
    assert accept_upload(library, submission)[1]


def test_what_is_refused_at_first_sight_is_never_stored(library: Library) -> None:
    with pytest.raises(MeshError):
        accept_upload(library, receive_paths({"a.txt": Path(__file__)}))
    assert list(library.files.keys()) == []


def test_names_from_outside_never_become_paths(library: Library, submission: Submission) -> None:
    shape, _ = accept_upload(library, submission)
    keys = list(library.files.keys("uploads"))
    assert keys == [file.key for file in shape.files]
    assert not any("a.ply" in key for key in keys)


def test_a_failed_shape_is_tried_again_with_the_new_files_and_its_old_ones_go(
    library: Library, submission: Submission
) -> None:
    first, _ = accept_upload(library, submission)
    fail_next(library)
    again, new = accept_upload(library, submission)
    assert (again.id, new, again.status) == (first.id, True, Status.QUEUED)
    assert list(library.files.keys("uploads")) == [file.key for file in again.files]


def test_removing_deletes_row_and_files(library: Library, submission: Submission) -> None:
    shape, _ = accept_upload(library, submission)
    library.files.put(f"shapes/{shape.id}/thumbnail.png", b"x")
    remove_shape(library, shape.id)
    assert list(library.files.keys()) == []
    with pytest.raises(ShapeNotFound):
        library.catalogue.get(shape.id)


def test_name_and_metadata_change_alone(library: Library, submission: Submission) -> None:
    shape, _ = accept_upload(library, submission)
    assert change_shape(library, shape.id, name="b").metadata == {"a": 1}
    changed = change_shape(library, shape.id, metadata={})
    assert (changed.name, changed.metadata) == ("b", {})
