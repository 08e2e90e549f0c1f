"""What was exported comes back: every row, every file, every answer."""

from pathlib import Path
from typing import Any

import pytest

from index.errors import LibraryNotEmpty, NewerFormat
from index.keys import Keys
from index.methods import METHODS
from index.scopes import Scope
from index.shapes import Shape, Status
from service.asking import Question
from service.backup import importing
from service.backup.exporting import export_library
from service.backup.importing import import_library
from service.jobs.sweeping import sweep
from service.library import Library
from service.retrieval import find_similar, remove_shape
from tests.backups import (
    Parts,
    add_queued,
    add_ready,
    describe,
    edited,
    exported,
    fail,
    files_of,
    fill,
    forged,
    of_the_first_schema,
    opened,
    parts_of,
    released,
    rows_of,
)
from tests.made_migrations import pretend_newer
from tests.storages import only_sqlite

pytestmark = pytest.mark.usefixtures("kept")  # on SQLite and on PostgreSQL, and with files in a bucket


def answers(library: Library) -> list[Any]:
    """Return what every ready shape finds by every kind of method."""
    ready = library.catalogue.list(status=Status.READY).items
    return [
        [(hit.rank, hit.distance, hit.shape) for hit in find_similar(library, shape.id, question).hits]
        for shape in ready
        for question in (
            *(Question(method=name) for name in METHODS),
            Question(weights={"log-hks": 1.0}),
        )
    ]


def distance(library: Library, one: Shape, other: Shape) -> float:
    """Return how far a shape that is searched for another finds it."""
    hits = find_similar(library, one.id, Question(method="hks")).hits
    return next(hit.distance for hit in hits if hit.shape.id == other.id)


def test_everything_comes_back_byte_for_byte(tmp_path: Path) -> None:
    archive = exported(tmp_path)
    with opened(tmp_path / "from") as before, opened(tmp_path / "to") as after:
        summary = import_library(after, archive)
        assert rows_of(after) == released(rows_of(before))
        assert files_of(after) == files_of(before)
        assert answers(after) == answers(before)
        assert len(answers(after)[0]) == 3
        assert summary.shapes == sum(after.catalogue.counts().values()) == 7
        assert summary.files == len(files_of(after))
        assert summary.damaged == ()


def test_a_library_that_is_exported_again_gives_the_same_members(tmp_path: Path) -> None:
    archive = exported(tmp_path)
    with opened(tmp_path / "to") as library:
        import_library(library, archive)
        export_library(library, tmp_path / "again.tar")
    one, other = parts_of(archive), parts_of(tmp_path / "again.tar")
    assert one.keys() == other.keys()
    assert {name for name in one if one[name] != other[name]} == {"library.json", "SHA256SUMS"}


def test_an_export_of_the_first_schema_is_brought_to_this_one(tmp_path: Path) -> None:
    with opened(tmp_path / "from") as before:
        fill(before)
        add_queued(before, 99, tags=["Vase"])
        rows, files, found = released(rows_of(before)), files_of(before), answers(before)
        export_library(before, tmp_path / "library.tar")
    archive = forged(tmp_path / "library.tar", of_the_first_schema)
    with opened(tmp_path / "to") as after:
        import_library(after, archive)
        jobs = [{**job, "queued_at": None} for job in rows["jobs"]]
        assert rows_of(after) == {**rows, "dismissals": [], "jobs": jobs}
        assert [tag["shown"] for tag in rows["tags"]] == ["Vase"]
        assert files_of(after) == files
        assert answers(after) == found


@only_sqlite
def test_the_steps_between_two_versions_work_on_the_rows(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    archive = exported(tmp_path)
    pretend_newer(monkeypatch, tmp_path)
    with opened(tmp_path / "to") as after, opened(tmp_path / "from") as before:
        import_library(after, archive)
        assert rows_of(after) == released(rows_of(before))
        initials = {row["name"]: row["initial"] for row in rows_of(after)["shapes"]}
        assert set(initials.values()) == {"s", "r"}
        assert all(name[0] == initial for name, initial in initials.items())
        assert answers(after) == answers(before)


@only_sqlite
def test_a_schema_of_a_later_version_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with monkeypatch.context() as patch:
        pretend_newer(patch, tmp_path)
        archive = exported(tmp_path)
    with opened(tmp_path / "to") as library, pytest.raises(NewerFormat, match="schema 'made'"):
        import_library(library, archive)


def test_a_library_with_shapes_is_left_alone(tmp_path: Path) -> None:
    archive = exported(tmp_path)
    with opened(tmp_path / "to") as library:
        add_ready(library, 10)
        rows, files = rows_of(library), files_of(library)
        with pytest.raises(LibraryNotEmpty, match="has 1"):
            import_library(library, archive)
        assert (rows_of(library), files_of(library)) == (rows, files)


def test_a_shape_that_comes_meanwhile_keeps_its_library(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    archive = exported(tmp_path)
    with opened(tmp_path / "to") as library, opened(tmp_path / "to") as other:
        put = importing._put_files

        def put_and_accept(*arguments: Any) -> int:
            add_ready(other, 33)
            return put(*arguments)

        monkeypatch.setattr(importing, "_put_files", put_and_accept)
        with pytest.raises(LibraryNotEmpty):
            import_library(library, archive)
        assert [shape.name for shape in library.catalogue.list().items] == ["shape \u00e9 33"]
        sweep(library, older_than=-1)
        assert len(files_of(library)) == 4


def test_keys_of_the_door_stay_where_they_are(tmp_path: Path) -> None:
    with opened(tmp_path / "from") as library:
        Keys(library.engine).create("from", Scope.READ)
        export_library(library, tmp_path / "library.tar")
    assert b"api_keys" not in (tmp_path / "library.tar").read_bytes()
    with opened(tmp_path / "to") as library:
        Keys(library.engine).create("to", Scope.READ)
        import_library(library, tmp_path / "library.tar")
        assert [key.name for key in Keys(library.engine).known()] == ["to"]


def test_jobs_that_others_held_are_free_at_once(tmp_path: Path) -> None:
    archive = exported(tmp_path)
    with opened(tmp_path / "to") as library:
        import_library(library, archive)
        assert library.queue.depth() == 2
        job = library.queue.claim("here", 60)
        assert job is not None
        assert job.attempts == 1


def test_a_lease_from_elsewhere_holds_nobody_up(tmp_path: Path) -> None:
    lease = {"lease_until": "9999-01-01T00:00:00Z", "worker": "w", "token": "t", "attempts": 3}

    def hold(parts: Parts) -> None:
        parts["tables/jobs.jsonl"] = edited(parts["tables/jobs.jsonl"], 0, **lease)

    archive = forged(exported(tmp_path), hold)
    with opened(tmp_path / "to") as library:
        import_library(library, archive)
        assert library.queue.depth() == 2


def test_a_library_that_is_open_elsewhere_notices(tmp_path: Path) -> None:
    archive = exported(tmp_path)
    with opened(tmp_path / "to") as running, opened(tmp_path / "to") as library:
        shape = add_ready(running, 77)
        find_similar(running, shape.id, Question())
        remove_shape(running, shape.id)
        import_library(library, archive)
        with opened(tmp_path / "from") as before:
            assert answers(running) == answers(before)


def test_a_library_that_is_emptied_and_restored_is_searched_anew(tmp_path: Path) -> None:
    archive = exported(tmp_path)
    with opened(tmp_path / "from") as library:
        expected, revision = answers(library), library.catalogue.revision()
        for shape in library.catalogue.list().items:
            remove_shape(library, shape.id)
        assert answers(library) == []
        last = library.catalogue.revision()
        import_library(library, archive)
        assert answers(library) == expected
        assert library.catalogue.revision() == last > revision  # whoever watches has heard of no later one


@only_sqlite
def test_an_index_that_was_saved_later_is_not_believed(tmp_path: Path) -> None:
    with opened(tmp_path / "lib") as library:
        one, shape = add_ready(library, 10), add_queued(library, 60)
        fail(library)
        export_library(library, tmp_path / "library.tar")
        library.catalogue.retry(shape.id)
        later = describe(library, red=250)
        found = distance(library, one, shape)
    for each in (tmp_path / "lib").glob("catalogue.sqlite3*"):
        each.unlink()
    with opened(tmp_path / "lib") as library:
        import_library(library, tmp_path / "library.tar")
        library.catalogue.retry(shape.id)
        assert describe(library, red=60).revision == later.revision  # so that only its content tells
        assert distance(library, one, shape) < found / 2


def test_damage_from_before_the_export_is_told_and_the_rest_comes(tmp_path: Path) -> None:
    with opened(tmp_path / "from") as library:
        one, other = add_ready(library, 10), add_ready(library, 60)
        library.files.delete(f"shapes/{one.id}/thumbnail.png")
        library.files.put(other.files[0].key, b"rotten")
        told = export_library(library, tmp_path / "library.tar").damaged
    with opened(tmp_path / "to") as library:
        summary = import_library(library, tmp_path / "library.tar")
        assert summary.damaged == told
        assert summary.shapes == 2
    assert {(damage.code, damage.shape, damage.what) for damage in told} == {
        ("file_missing", one.id, f"shapes/{one.id}/thumbnail.png"),
        ("file_altered", other.id, other.files[0].key),
    }
