"""A library of an earlier version is described anew, while it answers as before."""

import multiprocessing
from collections.abc import Iterator
from pathlib import Path

import pytest
from sqlalchemy import select

from index.database import reading
from index.errors import DescriptionsChanging, NewerDescriptions
from index.shapes import Status
from index.tables import PlainBlockRow, QuantisedBlockRow
from service.asking import Question
from service.backup.exporting import export_library
from service.backup.importing import import_library
from service.intake.submissions import receive_paths
from service.library import Library
from service.relations.duplicates import find_duplicates
from service.retrieval import Answer, change_shape, find_similar, remove_shape, search_upload
from service.vocabularies import learn_vocabulary
from tests.fakes import coloured_triangle
from tests.serving import open_fake_library, settings_for, wait_until
from tests.versions import (
    NEW,
    REFUSED,
    Here,
    accept,
    describe_newly,
    next_job,
    open_new_library,
    step,
    work_newly,
    work_off,
    working,
)

pytestmark = pytest.mark.usefixtures("database")  # on SQLite and on PostgreSQL
REDS = (10, 60, 110, 160, 210)
METHODS = ("fused", "colour-histogram", "chks")


@pytest.fixture
def earlier(tmp_path: Path) -> dict[int, str]:
    """Make a library as the earlier version does; return its shapes' ids by their red."""
    library = open_fake_library(settings_for(tmp_path / "library"))
    ids = {red: accept(library, red) for red in REDS}
    work_off(library)
    library.close()
    return ids


@pytest.fixture
def library(tmp_path: Path, earlier: dict[int, str]) -> Iterator[Library]:
    """Open it as the new version does."""
    opened = open_new_library(settings_for(tmp_path / "library", lease_seconds=0.5))
    yield opened
    opened.close()


def told(answer: Answer) -> list[tuple[str, float]]:
    """Return what an answer says, by names: ids differ from library to library."""
    return [(hit.shape.name, hit.distance) for hit in answer.hits]


def answers(library: Library, ids: dict[int, str]) -> dict[tuple[int, str], list[tuple[str, float]]]:
    """Ask for what is similar to each shape."""
    return {
        (red, method): told(find_similar(library, shape_id, Question(method=method)))
        for red, shape_id in ids.items()
        for method in METHODS
    }


def made_by(
    folder: Path, reds: tuple[int, ...], *, new: bool
) -> dict[tuple[int, str], list[tuple[str, float]]]:
    """Return the answers of a library that only ever knew one version."""
    library = (open_new_library if new else open_fake_library)(settings_for(folder))
    ids = {red: accept(library, red) for red in reds}
    work_off(library)
    found = answers(library, ids)
    library.close()
    return found


def ask(library: Library, red: int) -> Answer:
    """Search with a mesh that is not kept."""
    with library.incoming.scratch() as folder:
        path = folder / "mesh.ply"
        path.write_bytes(coloured_triangle(red=red))
        submission = receive_paths({"mesh.ply": path})
        return search_upload(library, Here(), submission, Question(), describe_newly)


def test_every_answer_is_of_one_version_the_earlier_until_the_last_shape_and_then_the_new(
    library: Library, earlier: dict[int, str], tmp_path: Path
) -> None:
    before = made_by(tmp_path / "old", REDS, new=False)
    after = made_by(tmp_path / "new", REDS, new=True)
    assert before != after
    assert answers(library, earlier) == before
    done = []
    while step(library):
        progress = library.catalogue.renewal()
        assert progress is not None
        done.append((progress.done, progress.failed, progress.total))
        assert answers(library, earlier) == before
    assert done == [(number, 0, len(REDS)) for number in range(1, len(REDS) + 1)]
    assert library.catalogue.renewal() is None
    assert answers(library, earlier) == after
    assert {library.catalogue.get(i).fingerprint for i in earlier.values()} == {NEW.fingerprint()}
    assert {(library.catalogue.get(i).facts or {})["area"] for i in earlier.values()} == {2.0}


def test_a_mesh_is_compared_with_what_is_described_anew_and_the_answer_says_so(
    library: Library, earlier: dict[int, str], tmp_path: Path
) -> None:
    with pytest.raises(DescriptionsChanging, match="begins when a worker of it runs"):
        ask(library, 61)
    seen = []
    while step(library):
        answer = ask(library, 61)
        assert answer.partly is not None
        seen.append((answer.partly.done, len(answer.hits)))
    assert seen == [(number, number) for number in range(1, len(REDS) + 1)]
    whole = ask(library, 61)
    assert whole.partly is None
    assert told(whole) == told(answer)
    assert not library.upcoming.loaded


def test_what_comes_meanwhile_is_ready_and_changes_no_earlier_answer_before_the_end(
    library: Library, earlier: dict[int, str], tmp_path: Path
) -> None:
    before = answers(library, earlier)
    assert step(library)
    late = accept(library, 61)
    assert step(library)  # before all that is described anew
    shape = library.catalogue.get(late)
    assert (shape.status, shape.fingerprint) == (Status.READY, NEW.fingerprint())
    assert answers(library, earlier) == before
    answer = find_similar(library, late, Question())
    assert answer.partly is not None
    assert len(answer.hits) == 1
    assert find_duplicates(library).items == ()
    work_off(library)
    assert answers(library, {**earlier, 61: late}) == made_by(tmp_path / "new", (*REDS, 61), new=True)


def test_shapes_are_renamed_and_removed_meanwhile(
    library: Library, earlier: dict[int, str], tmp_path: Path
) -> None:
    assert step(library)
    held = next_job(library)
    assert held is not None
    remove_shape(library, held.shape_id)
    kept = {red: shape_id for red, shape_id in earlier.items() if shape_id != held.shape_id}
    assert answers(library, kept) == made_by(tmp_path / "old", tuple(kept), new=False)
    renamed = next(iter(kept.values()))
    change_shape(library, renamed, name="another name")
    work_off(library)
    assert library.catalogue.get(renamed).name == "another name"
    change_shape(library, renamed, name=f"shape {next(iter(kept))}")
    assert answers(library, kept) == made_by(tmp_path / "new", tuple(kept), new=True)
    assert list(library.files.keys(f"shapes/{held.shape_id}")) == []


def test_a_shape_that_the_new_version_refuses_answers_to_the_end_and_is_failed_then(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    old = open_fake_library(settings_for(tmp_path / "library"))
    ids = {10: accept(old, 10), 60: accept(old, 60, REFUSED)}
    work_off(old)
    before = answers(old, ids)
    old.close()
    library = open_new_library(settings_for(tmp_path / "library"))
    assert step(library)
    assert step(library)
    progress = library.catalogue.renewal()
    assert progress is not None
    assert (progress.done, progress.failed, progress.total) == (1, 1, 2)
    assert answers(library, ids) == before
    assert any("cannot be described anew, too_complex" in line for line in caplog.messages)
    work_off(library)
    shape = library.catalogue.get(ids[60])
    assert (shape.status, shape.error_code) == (Status.FAILED, "too_complex")
    assert library.catalogue.get(ids[10]).status == Status.READY
    assert find_similar(library, ids[10], Question()).hits == ()
    assert library.files.keys(f"shapes/{ids[60]}")  # its picture is there as before
    library.catalogue.retry(ids[60])
    assert step(library)
    assert library.catalogue.get(ids[60]).status == Status.FAILED
    library.close()


def test_what_the_earlier_version_made_is_deleted_after_the_end(
    library: Library, earlier: dict[int, str]
) -> None:
    work_off(library)
    assert step(library) is False  # an idle worker tidies up
    assert library.catalogue.outdated(100) == []
    for shape_id in earlier.values():
        folders = {key.rpartition("/")[0] for key in library.files.keys(f"shapes/{shape_id}")}
        assert folders == {f"shapes/{shape_id}/{NEW.fingerprint()}"}
    with reading(library.engine) as session:
        for column in (PlainBlockRow.fingerprint, QuantisedBlockRow.vocabulary_id):
            assert len(session.scalars(select(column).distinct()).all()) == 1


def test_a_process_of_the_earlier_version_answers_to_the_end_and_is_refused_then(
    library: Library, earlier: dict[int, str], tmp_path: Path
) -> None:
    old = open_fake_library(settings_for(tmp_path / "library"))
    before = answers(old, earlier)
    for _ in range(2):
        assert step(library)
        assert next_job(old) is None  # it leaves to the new version what is the new version's
        assert answers(old, earlier) == before
    by_old = accept(old, 85)
    assert step(old)
    assert old.catalogue.get(by_old).fingerprint != NEW.fingerprint()
    assert "shape 85" in [name for name, _ in told(find_similar(old, earlier[60], Question()))]
    work_off(library)
    assert library.catalogue.get(by_old).fingerprint == NEW.fingerprint()
    waiting = accept(old, 90)
    assert next_job(old) is None
    assert old.catalogue.get(waiting).status == Status.QUEUED
    with pytest.raises(NewerDescriptions, match="update this one"):
        find_similar(old, earlier[60], Question())
    with pytest.raises(NewerDescriptions, match="update this one"):
        ask(old, 61)
    old.close()
    with pytest.raises(NewerDescriptions, match="update this one"):
        open_fake_library(settings_for(tmp_path / "library"))


def test_no_words_are_learnt_meanwhile(library: Library, earlier: dict[int, str]) -> None:
    with pytest.raises(DescriptionsChanging):
        learn_vocabulary(library)
    assert step(library)
    with pytest.raises(DescriptionsChanging):
        learn_vocabulary(library)


def test_a_killed_worker_costs_time_and_no_shape(
    tmp_path: Path, library: Library, earlier: dict[int, str]
) -> None:
    before = answers(library, earlier)
    killed = multiprocessing.get_context("spawn").Process(target=work_newly, args=(library.settings,))
    killed.start()

    def done() -> int:
        progress = library.catalogue.renewal()
        return 0 if progress is None else progress.done

    wait_until(lambda: done() > 0 or not killed.is_alive())
    killed.kill()
    killed.join()
    assert answers(library, earlier) in (before, made_by(tmp_path / "new", REDS, new=True))
    with working(library):
        wait_until(
            lambda: {library.catalogue.get(i).fingerprint for i in earlier.values()} == {NEW.fingerprint()}
        )
    assert answers(library, earlier) == made_by(tmp_path / "new", REDS, new=True)
    assert library.catalogue.counts()[Status.READY] == len(REDS)


def test_a_library_that_is_exported_meanwhile_goes_on_where_it_was(
    library: Library, earlier: dict[int, str], tmp_path: Path
) -> None:
    before = answers(library, earlier)
    for _ in range(2):
        assert step(library)
    held = next_job(library)
    assert held is not None
    export_library(library, tmp_path / "library.tar")
    copy = open_new_library(settings_for(tmp_path / "copy"))
    import_library(copy, tmp_path / "library.tar")
    progress = copy.catalogue.renewal()
    assert progress is not None
    assert (progress.done, progress.total) == (2, len(REDS))
    assert answers(copy, earlier) == before
    work_off(copy)
    assert answers(copy, earlier) == made_by(tmp_path / "new", REDS, new=True)
    export_library(copy, tmp_path / "after.tar")
    copy.close()
    again = open_new_library(settings_for(tmp_path / "again"))
    assert import_library(again, tmp_path / "after.tar").damaged == ()
    assert find_similar(again, earlier[60], Question()).hits
    again.close()
