"""A library learns its own vocabulary while it goes on answering."""

import threading
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from index.errors import BadVocabulary
from index.packing import rounded
from index.shapes import Status
from service.asking import Question
from service.intake.submissions import receive_paths
from service.jobs.recording import record_description
from service.library import Library
from service.quantisation import quantise
from service.retrieval import accept_upload, find_similar
from service.storage import load_signatures
from service.vocabularies import NoVocabulary, active_vocabulary, adopt_vocabulary, learn_vocabulary
from tests.fakes import coloured_triangle, describe_quickly
from tests.serving import fake_vocabulary, open_fake_library, settings_for
from worker.parameters import Parameters

pytestmark = pytest.mark.usefixtures("database")  # on SQLite and on PostgreSQL


@pytest.fixture
def library(tmp_path: Path) -> Iterator[Library]:
    opened = open_fake_library(settings_for(tmp_path / "library"))
    yield opened
    opened.close()


def add_ready(library: Library, level: int) -> str:
    path = library.incoming.folder / "a.ply"
    path.write_bytes(coloured_triangle(level))
    accept_upload(library, receive_paths({"a.ply": path}))
    job = library.queue.claim("test", 60)
    assert job is not None
    description = describe_quickly({"a.ply": path.read_bytes()}, False, library.parameters, library.limits)
    return record_description(library, job, description).id


def test_every_ready_shape_is_quantised_again_from_its_stored_signatures(library: Library) -> None:
    ids = [add_ready(library, level) for level in (0, 60, 120, 250)]
    before = active_vocabulary(library).id
    heard: list[tuple[int, int]] = []
    vocabulary = learn_vocabulary(library, lambda done, known: heard.append((done, known)))
    assert vocabulary.id != before
    assert active_vocabulary(library).id == vocabulary.id
    assert heard == [(1, 4), (2, 4), (3, 4), (4, 4)]
    for shape_id in ids:
        blocks = library.catalogue.blocks(shape_id, vocabulary.id)
        for name, expected in quantise(load_signatures(library.files, shape_id), vocabulary).items():
            np.testing.assert_array_equal(blocks[name], rounded(name, expected))


def test_queries_are_answered_with_the_old_vocabulary_until_the_new_one_is_complete(library: Library) -> None:
    ids = [add_ready(library, level) for level in (0, 100, 200)]
    old = active_vocabulary(library).id
    seen = []

    def look(done: int, known: int) -> None:
        if done < known:
            answer = find_similar(library, ids[0], Question(method="hks"))
            seen.append((active_vocabulary(library).id, [hit.shape.id for hit in answer.hits]))

    adopt_vocabulary(library, fake_vocabulary(seed=5), look)
    assert seen == [(old, ids[1:])] * 2
    after = find_similar(library, ids[0], Question(method="hks"))
    assert [hit.shape.id for hit in after.hits] == ids[1:]


def test_a_shape_that_becomes_ready_meanwhile_is_not_forgotten(library: Library) -> None:
    add_ready(library, 0)
    late: list[str] = []

    def add_one_late(done: int, _: int) -> None:
        if done == 1:
            late.append(add_ready(library, 77))

    adopt_vocabulary(library, fake_vocabulary(seed=5), add_one_late)
    assert "hks-0" in library.catalogue.blocks(late[0], active_vocabulary(library).id)


def test_a_description_made_during_a_change_is_recorded_in_the_new_words(library: Library) -> None:
    path = library.incoming.folder / "a.ply"
    path.write_bytes(coloured_triangle(3))
    shape, _ = accept_upload(library, receive_paths({"a.ply": path}))
    job = library.queue.claim("test", 60)
    assert job is not None
    description = describe_quickly({"a.ply": path.read_bytes()}, False, library.parameters, library.limits)
    change = threading.Thread(
        target=adopt_vocabulary, args=(library, fake_vocabulary(seed=5), lambda *_: None)
    )
    change.start()
    assert record_description(library, job, description).status == Status.READY
    change.join()
    assert set(library.catalogue.blocks(shape.id, active_vocabulary(library).id)) >= {"hks-0", "log-hks"}


def test_nothing_can_be_learnt_from_nothing(library: Library) -> None:
    before = active_vocabulary(library).id
    with pytest.raises(BadVocabulary):
        learn_vocabulary(library)
    assert active_vocabulary(library).id == before


def test_parameters_that_no_vocabulary_fits_are_named(tmp_path: Path) -> None:
    library = Library.open(
        settings_for(tmp_path), parameters=Parameters(vertices=123), vocabulary=fake_vocabulary()
    )
    with pytest.raises(NoVocabulary, match="learn-vocabulary"):
        active_vocabulary(library)
    library.close()
