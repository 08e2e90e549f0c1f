"""Services on one database show each other's shapes, each with indexes and a folder of its own."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from index.shapes import Status
from service.asking import Question
from service.library import Library
from service.retrieval import find_similar, remove_shape
from tests.fakes import coloured_triangle
from tests.serving import open_fake_library, settings_for
from tests.working import SameThread, Working, accept, settled

pytestmark = pytest.mark.usefixtures("database")  # on SQLite and on PostgreSQL


@pytest.fixture
def library(tmp_path: Path) -> Iterator[Library]:
    opened = open_fake_library(settings_for(tmp_path / "library"))
    yield opened
    opened.close()


@pytest.fixture
def replica(library: Library, tmp_path: Path) -> Iterator[Library]:
    opened = open_fake_library(settings_for(tmp_path / "replica", database_url=library.settings.url))
    yield opened
    opened.close()


def found(replica: Library, shape_id: str) -> set[str]:
    answer = find_similar(replica, shape_id, Question(method="hks", limit=50))
    return {hit.shape.id for hit in answer.hits}


def test_the_next_search_of_a_replica_knows_what_was_just_recorded(
    library: Library, replica: Library
) -> None:
    with Working(library, SameThread()):
        first, *others = (accept(library, f"{number}.ply", coloured_triangle(number)) for number in range(4))
        assert {settled(library, shape_id).status for shape_id in (first, *others)} == {Status.READY}
        assert found(replica, first) == set(others)
        new = accept(library, "new.ply", coloured_triangle(99))
        assert settled(library, new).status == Status.READY
        assert found(replica, first) == {*others, new}  # the very next search: no time passes
    remove_shape(library, others[0])
    assert found(replica, first) == {*others[1:], new}
