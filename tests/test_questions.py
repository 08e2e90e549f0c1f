from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from index.errors import NotReady, ShapeNotFound
from tests.catalogues import HISTOGRAM, WORDS, Opened, add_queued, add_ready, open_catalogue

pytestmark = pytest.mark.usefixtures("database")  # on SQLite and on PostgreSQL

NAMES = {*HISTOGRAM, *WORDS}


@pytest.fixture
def opened(tmp_path: Path) -> Iterator[Opened]:
    opened = open_catalogue(tmp_path)
    yield opened
    opened.engine.dispose()


def test_a_query_has_both_kinds_of_blocks_as_everything_of_it_has(opened: Opened) -> None:
    add_ready(opened, "a")
    add_ready(opened, "b")
    found = opened.catalogue.query_blocks("a", NAMES)
    assert found.vocabulary_id == opened.vocabulary_id
    expected = opened.catalogue.blocks("a", opened.vocabulary_id)
    assert found.blocks.keys() == expected.keys() == NAMES
    for name, block in expected.items():
        np.testing.assert_array_equal(found.blocks[name], block)
    assert opened.catalogue.query_blocks("a", ["hks-0", "unknown"]).blocks.keys() == {"hks-0"}
    assert opened.catalogue.query_blocks("a", []).blocks == {}


def test_only_a_ready_shape_can_be_a_query(opened: Opened) -> None:
    add_queued(opened, "waiting")
    with pytest.raises(NotReady, match="queued"):
        opened.catalogue.query_blocks("waiting", NAMES)
    with pytest.raises(ShapeNotFound, match="unknown"):
        opened.catalogue.query_blocks("unknown", NAMES)


def test_one_block_is_told_of_the_shapes_that_have_it(opened: Opened) -> None:
    add_ready(opened, "a")
    add_ready(opened, "b")
    add_queued(opened, "waiting")
    (name,) = HISTOGRAM
    found = opened.catalogue.one_block(["b", "a", "waiting", "unknown"], name, opened.vocabulary_id)
    assert found.keys() == {"a", "b"}
    np.testing.assert_array_equal(found["a"], opened.catalogue.blocks("a", None)[name])
    assert opened.catalogue.one_block([], name, opened.vocabulary_id) == {}
    assert opened.catalogue.one_block(["a"], "unknown", opened.vocabulary_id) == {}


def test_many_shapes_are_what_each_is_alone(opened: Opened, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("index.questions._AT_ONCE", 2)
    for shape_id in ("a", "b", "c"):
        add_ready(opened, shape_id)
    add_queued(opened, "waiting")
    found = opened.catalogue.get_many(["c", "waiting", "a", "a", "unknown", "b"])
    assert found == {shape_id: opened.catalogue.get(shape_id) for shape_id in ("a", "b", "c", "waiting")}
    assert opened.catalogue.get_many([]) == {}
