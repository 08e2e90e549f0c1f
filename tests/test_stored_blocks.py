from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from sqlalchemy import select
from sqlalchemy.orm import Session

from index.errors import NotReady, ShapeNotFound
from index.methods import METHODS
from index.packing import PACKINGS, rounded
from index.tables import PlainBlockRow, QuantisedBlockRow
from index.vocabulary import default_vocabulary
from service.quantisation import quantise
from service.samples import make_samples
from tests.catalogues import HISTOGRAM, WORDS, Opened, add_queued, add_ready, open_catalogue
from worker.describe import describe
from worker.reading.upload import Upload

pytestmark = pytest.mark.usefixtures("database")  # on SQLite and on PostgreSQL


@pytest.fixture
def opened(tmp_path: Path) -> Iterator[Opened]:
    opened = open_catalogue(tmp_path)
    yield opened
    opened.engine.dispose()


def test_both_kinds_of_blocks_are_joined_in_the_order_of_ids(opened: Opened) -> None:
    for shape_id in ("c", "a", "b"):
        add_ready(opened, shape_id)
    add_queued(opened, "waiting")
    rows = list(opened.catalogue.block_rows(opened.vocabulary_id))
    assert [shape_id for shape_id, _ in rows] == ["a", "b", "c"]
    for _, blocks in rows:
        assert blocks.keys() == HISTOGRAM.keys() | WORDS.keys()
        assert blocks["hks-0"].dtype == np.float32
        np.testing.assert_array_equal(blocks["hks-0"], WORDS["hks-0"])


def test_rows_can_be_asked_for_by_revision_name_vocabulary_and_id(opened: Opened) -> None:
    first = add_ready(opened, "a")
    add_ready(opened, "b")
    add_ready(opened, "c")
    opened.catalogue.remove("c")
    told = opened.catalogue.block_rows

    def ids(rows: Iterator[tuple[str, object]]) -> list[str]:
        return [shape_id for shape_id, _ in rows]

    assert ids(told(opened.vocabulary_id, first.revision)) == ["b"]
    assert ids(told(opened.vocabulary_id, but={"a"})) == ["b"]
    assert ids(told(opened.vocabulary_id, opened.catalogue.revision())) == []
    assert [set(blocks) for _, blocks in told(opened.vocabulary_id, names=["hks-0"])] == [{"hks-0"}] * 2
    assert [set(blocks) for _, blocks in told(None)] == [{"colour-histogram"}] * 2


def test_more_shapes_than_one_statement_takes_come_once_each(
    opened: Opened, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("index.stored_blocks._AT_ONCE", 3)
    for number in range(10):
        add_ready(opened, f"s{number}")
    rows = list(opened.catalogue.block_rows(opened.vocabulary_id))
    assert [shape_id for shape_id, _ in rows] == [f"s{number}" for number in range(10)]


def test_rows_that_are_being_read_show_one_moment(opened: Opened, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("index.stored_blocks._AT_ONCE", 1)
    for shape_id in "ab":
        add_ready(opened, shape_id)
    rows = opened.catalogue.block_rows(opened.vocabulary_id)
    assert next(rows)[0] == "a"
    opened.catalogue.remove("b")
    assert next(rows)[1].keys() == HISTOGRAM.keys() | WORDS.keys()


def test_a_shape_without_descriptors_is_named(opened: Opened) -> None:
    add_queued(opened, "a")
    with pytest.raises(NotReady):
        opened.catalogue.blocks("a", opened.vocabulary_id)
    with pytest.raises(ShapeNotFound):
        opened.catalogue.blocks("b", opened.vocabulary_id)


def test_revisions_of_ready_shapes_are_those_of_their_last_change(opened: Opened) -> None:
    a = add_ready(opened, "a")
    add_ready(opened, "b")
    b = opened.catalogue.update("b", name="new")
    add_queued(opened, "c")
    assert opened.catalogue.ready_revisions() == {"a": a.revision, "b": b.revision}


def test_the_first_stage_of_fused_takes_less_than_a_kilobyte_of_a_sample(opened: Opened) -> None:
    described = describe(Upload(files=next(iter(make_samples())).files))
    words = quantise(described.signatures, default_vocabulary())
    add_ready(opened, "a", described.blocks, words)
    names = [block.name for block in METHODS["fused"].blocks]
    with Session(opened.engine) as session:
        stored = [
            len(data)
            for table in (PlainBlockRow, QuantisedBlockRow)
            for data in session.scalars(select(table.data).where(table.name.in_(names)))
        ]
    assert len(stored) == len(names)
    assert sum(stored) <= 1_024
    made, found = {**described.blocks, **words}, opened.catalogue.blocks("a", opened.vocabulary_id)
    for name in names:
        np.testing.assert_array_equal(found[name], rounded(name, made[name]), strict=True)
    assert sum(PACKINGS[name].pack(found[name]).nbytes for name in names) == 741  # of a row in the index
