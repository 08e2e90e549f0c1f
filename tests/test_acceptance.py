from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from sqlalchemy import func, select
from sqlalchemy.exc import IntegrityError

from index.database import reading
from index.errors import NotFailed, ShapeNotFound
from index.shapes import Shape, Status, StoredFile
from index.tables import FileRow, JobRow, ShapeRow, TombstoneRow
from tests.catalogues import Opened, add_queued, add_ready, open_catalogue

pytestmark = pytest.mark.usefixtures("database")  # on SQLite and on PostgreSQL


@pytest.fixture
def opened(tmp_path: Path) -> Iterator[Opened]:
    opened = open_catalogue(tmp_path)
    yield opened
    opened.engine.dispose()


def stored(*names: str) -> list[StoredFile]:
    return [StoredFile(name=name, key=f"k/{name}", size=len(name), sha256="ab") for name in names]


def accept(opened: Opened, shape_id: str, sha256: str, files: list[StoredFile]) -> tuple[Shape, bool]:
    return opened.catalogue.accept(id=shape_id, name=shape_id, metadata={}, sha256=sha256, files=files)


def count(opened: Opened, table: type) -> int:
    with reading(opened.engine) as session:
        return session.scalars(select(func.count()).select_from(table)).one()


def fail(opened: Opened) -> Shape:
    job = opened.queue.claim("w", 60)
    assert job is not None
    return opened.catalogue.record_failed(job, code="truncated", detail="too short")


def test_a_new_shape_is_queued_with_its_files_and_one_job(opened: Opened) -> None:
    shape, new = opened.catalogue.accept(
        id="a",
        name="Bird",
        metadata={"tag": ["blue", 1]},
        sha256="sum",
        files=stored("b.obj", "a.mtl"),
        allow_untextured=True,
    )
    assert new
    assert shape == opened.catalogue.get("a")
    assert (shape.name, shape.metadata, shape.status) == ("Bird", {"tag": ["blue", 1]}, Status.QUEUED)
    assert shape.allow_untextured
    assert shape.files == tuple(stored("b.obj", "a.mtl"))
    assert shape.created_at.utcoffset() is not None
    assert opened.queue.depth() == 1


def test_known_content_gives_the_known_shape_and_changes_nothing(opened: Opened) -> None:
    first, _ = accept(opened, "a", "sum", stored("a.ply"))
    before = opened.catalogue.revision()
    assert accept(opened, "b", "sum", stored("b.ply")) == (first, False)
    assert opened.catalogue.revision() == before
    assert opened.catalogue.find_content("sum") == first
    assert opened.catalogue.find_content("other") is None


def test_known_content_that_failed_is_tried_again_with_the_new_files(opened: Opened) -> None:
    accept(opened, "a", "sum", stored("a.ply", "gone.png"))
    fail(opened)
    shape, new = accept(opened, "b", "sum", stored("b.ply"))
    assert new
    assert (shape.id, shape.name, shape.status) == ("a", "b", Status.QUEUED)
    assert shape.files == tuple(stored("b.ply"))
    assert shape.error_code is None
    assert opened.catalogue.file_keys() == {"k/b.ply"}
    assert opened.queue.depth() == 1


def test_one_of_many_identical_uploads_at_once_is_accepted(tmp_path: Path) -> None:
    catalogues = [open_catalogue(tmp_path) for _ in range(4)]

    def upload(number: int) -> tuple[Shape, bool]:
        return accept(catalogues[number % 4], f"s{number}", f"sum {number % 5}", stored("a.ply"))

    with ThreadPoolExecutor(8) as threads:
        answers = list(threads.map(upload, range(40)))
    assert sum(new for _, new in answers) == 5
    assert len({shape.id for shape, _ in answers}) == 5
    assert [count(catalogues[0], table) for table in (ShapeRow, JobRow, FileRow)] == [5, 5, 5]
    for opened in catalogues:
        opened.engine.dispose()


def test_a_refused_acceptance_leaves_no_part_of_itself(opened: Opened) -> None:
    twice = StoredFile(name="a", key="k", size=-1, sha256=None)  # type: ignore[arg-type] # what the database must refuse
    with pytest.raises(IntegrityError):
        accept(opened, "a", "sum", [*stored("a.ply"), twice])
    assert [count(opened, table) for table in (ShapeRow, JobRow, FileRow)] == [0, 0, 0]


def test_only_failed_shapes_are_tried_again(opened: Opened) -> None:
    add_queued(opened, "a")
    with pytest.raises(NotFailed):
        opened.catalogue.retry("a")
    assert fail(opened).status == Status.FAILED
    assert opened.queue.depth() == 0
    again = opened.catalogue.retry("a")
    assert (again.status, again.error_code, again.error_detail) == (Status.QUEUED, None, None)
    job = opened.queue.claim("w", 60)
    assert job is not None
    assert job.attempts == 1
    with pytest.raises(ShapeNotFound):
        opened.catalogue.retry("b")


def test_a_removed_id_that_comes_again_counts_as_changed_alone(opened: Opened) -> None:
    add_ready(opened, "a")
    opened.catalogue.remove("a")
    before = opened.catalogue.revision()
    add_ready(opened, "a")
    changes = opened.catalogue.changes_since(before)
    assert (changes.changed, changes.removed) == (("a",), ())
    assert count(opened, TombstoneRow) == 0
