"""Queries are remembered for an hour, as well as can be."""

from collections.abc import Iterator
from datetime import timedelta
from pathlib import Path

import pytest

from index.errors import StorageFull
from index.revisions import now
from service import remembering
from service.intake.submissions import ReceivedFile, Submission
from service.jobs.sweeping import sweep
from service.library import Library
from service.remembered_words import in_active_words
from service.remembering import LIFETIME, QueryNotFound, forget_old, recall, remember, remembered_file
from tests.fakes import coloured_triangle, describe_quickly
from tests.serving import fake_vocabulary, open_fake_library, settings_for
from tests.storages import make_older
from worker.describe import Description
from worker.parameters import Parameters
from worker.reading.limits import Limits

pytestmark = pytest.mark.usefixtures("storage")  # with files in a folder and in a bucket


@pytest.fixture
def library(tmp_path: Path) -> Iterator[Library]:
    library = open_fake_library(settings_for(tmp_path / "library"))
    yield library
    library.close()


@pytest.fixture
def submission(tmp_path: Path) -> Submission:
    path = tmp_path / "sent"
    path.write_bytes(coloured_triangle())
    file = ReceivedFile(name="cups/blue.ply", path=path, size=path.stat().st_size, sha256="ab")
    return Submission(files=(file,))


@pytest.fixture
def described(submission: Submission) -> Description:
    return describe_quickly(submission.contents, False, Parameters(), Limits())


def remembered(library: Library, submission: Submission, described: Description) -> str:
    query_id = remember(library, submission, described, described.blocks, fake_vocabulary().id)
    assert query_id is not None
    return query_id


def kept(library: Library) -> set[str]:
    return {key.split("/")[1] for key in library.files.keys("queries")}


def grow_older(library: Library, query_id: str, seconds: float) -> None:
    for key in library.files.keys(f"queries/{query_id}"):
        make_older(library.files, key, seconds)


def test_what_is_recalled_is_what_was_described(
    library: Library, submission: Submission, described: Description
) -> None:
    found = recall(library, remembered(library, submission, described))
    assert (found.name, found.facts, found.files) == ("blue", described.facts, (("cups/blue.ply", "ab"),))
    assert found.blocks.keys() == described.blocks.keys()
    for name, block in found.blocks.items():
        assert (block == described.blocks[name]).all()
    assert (found.ladder == described.signatures["landmark-ladder"]).all()


def test_it_is_no_shape(library: Library, submission: Submission, described: Description) -> None:
    remembered(library, submission, described)
    assert library.catalogue.list().items == ()
    assert not list(library.files.keys("shapes"))


def test_after_its_hour_it_is_forgotten_although_nobody_swept(
    library: Library, submission: Submission, described: Description
) -> None:
    query_id = remembered(library, submission, described)
    recall(library, query_id, now() + LIFETIME - timedelta(seconds=30))
    with pytest.raises(QueryNotFound, match="send its mesh again"):
        recall(library, query_id, now() + LIFETIME)


def test_sweeping_removes_what_is_over_its_hour_alone(
    library: Library, submission: Submission, described: Description
) -> None:
    old, young = (remembered(library, submission, described) for _ in range(2))
    grow_older(library, old, LIFETIME.total_seconds() + 1)
    assert sweep(library, older_than=0) == 1
    assert kept(library) == {young}
    assert forget_old(library.files, 0) == 1
    assert kept(library) == set()


def test_there_are_only_so_many_and_the_oldest_go_first(
    library: Library, submission: Submission, described: Description, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(remembering, "MOST", 3)
    made = []
    for place in range(5):
        made.append(remembered(library, submission, described))
        grow_older(library, made[-1], 100 - place)
    assert kept(library) == set(made[2:])


def test_a_full_disk_costs_the_memory_alone(
    library: Library, submission: Submission, described: Description, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object, **__: object) -> int:
        raise StorageFull("full")

    with monkeypatch.context() as patch:
        patch.setattr(library.files, "put", full)
        assert remember(library, submission, described, described.blocks, "v") is None
    assert kept(library) == set()


@pytest.mark.parametrize("odd", ["", "..", "a" * 31, "A" * 32, "a" * 33, "g" * 32, "\0" * 32, "a/" * 16])
def test_what_cannot_be_an_id_is_never_a_path(library: Library, odd: str) -> None:
    with pytest.raises(QueryNotFound):
        recall(library, odd)


def test_numbers_of_another_version_are_forgotten(
    library: Library, submission: Submission, described: Description
) -> None:
    earlier = Description(**{**vars(described), "fingerprint": "of an earlier version"})
    with pytest.raises(QueryNotFound):
        recall(library, remembered(library, submission, earlier))


def test_another_vocabulary_makes_its_words_anew(
    library: Library, submission: Submission, described: Description
) -> None:
    found = recall(library, remembered(library, submission, described))
    assert in_active_words(library, found) == (fake_vocabulary().id, dict(found.blocks))
    other = fake_vocabulary(seed=1)
    library.catalogue.add_vocabulary(other)
    library.catalogue.activate(other.id)
    vocabulary_id, blocks = in_active_words(library, found)
    assert vocabulary_id == other.id
    assert "log-hks" in blocks.keys() - found.blocks.keys()


@pytest.mark.parametrize("name", ["query.json", "blocks.npz"])
def test_what_a_power_cut_tore_is_forgotten(
    library: Library, submission: Submission, described: Description, name: str
) -> None:
    query_id = remembered(library, submission, described)
    key = f"queries/{query_id}/{name}"
    library.files.put(key, library.files.get(key)[:40])
    with pytest.raises(QueryNotFound):
        recall(library, query_id)


def test_pictures_go_with_the_hour(library: Library, submission: Submission, described: Description) -> None:
    query_id = remembered(library, submission, described)
    assert remembered_file(library, query_id, "thumbnail.png") == described.thumbnail
    library.files.delete(f"queries/{query_id}/query.json")
    with pytest.raises(QueryNotFound):
        remembered_file(library, query_id, "thumbnail.png")
