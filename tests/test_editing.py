from collections.abc import Iterator
from pathlib import Path

import pytest
from sqlalchemy import func, select

from index.database import reading
from index.errors import LeaseLost, ShapeNotFound
from index.shapes import StoredFile
from index.tables import Base
from tests.catalogues import Opened, add_queued, add_ready, open_catalogue

pytestmark = pytest.mark.usefixtures("database")  # on SQLite and on PostgreSQL


@pytest.fixture
def opened(tmp_path: Path) -> Iterator[Opened]:
    opened = open_catalogue(tmp_path)
    yield opened
    opened.engine.dispose()


def test_name_and_metadata_change_apart_from_each_other(opened: Opened) -> None:
    first = add_queued(opened, "a", tag="x")
    named = opened.catalogue.update("a", name="new")
    assert (named.name, named.metadata) == ("new", {"tag": "x"})
    tagged = opened.catalogue.update("a", metadata={})
    assert (tagged.name, tagged.metadata) == ("new", {})
    assert first.revision < named.revision < tagged.revision
    assert tagged.created_at == first.created_at < tagged.updated_at


def test_changing_nothing_is_no_change(opened: Opened) -> None:
    shape = add_queued(opened, "a")
    assert opened.catalogue.update("a") == shape
    assert opened.catalogue.revision() == shape.revision


def test_removal_leaves_a_tombstone_and_nothing_else(opened: Opened) -> None:
    with reading(opened.engine) as session:
        tables = {
            table.name: select(func.count()).select_from(table) for table in Base.metadata.sorted_tables
        }
        before = {name: session.scalars(count).one() for name, count in tables.items()}
    add_ready(opened, "a")
    add_queued(opened, "b")
    for shape_id in ("a", "b"):
        files = opened.catalogue.remove(shape_id)
        assert files == (StoredFile(name="a.ply", key=f"shapes/{shape_id}/files/0", size=3, sha256="ab"),)
    with reading(opened.engine) as session:
        after = {name: session.scalars(count).one() for name, count in tables.items()}
    assert after == {**before, "tombstones": 2, "finished_jobs": 1}  # how fast one was


def test_removing_takes_the_job_from_its_worker(opened: Opened) -> None:
    add_queued(opened, "a")
    job = opened.queue.claim("w", 60)
    assert job is not None
    opened.catalogue.remove("a")
    with pytest.raises(LeaseLost):
        opened.queue.heartbeat(job, 60)
    with pytest.raises(LeaseLost):
        opened.catalogue.record_failed(job, code="x", detail="y")
    assert opened.queue.claim("w", 60) is None


def test_what_is_not_there_is_neither_changed_nor_removed(opened: Opened) -> None:
    with pytest.raises(ShapeNotFound):
        opened.catalogue.update("nobody", name="x")
    with pytest.raises(ShapeNotFound):
        opened.catalogue.remove("nobody")
