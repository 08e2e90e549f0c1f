import threading
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from sqlalchemy import func, select

from index.database import reading
from index.errors import BadBlock, FingerprintMismatch, NotReady, ShapeNotFound, UnknownVocabulary
from index.tables import QuantisedBlockRow
from tests.catalogues import Opened, add_queued, add_ready, make_vocabulary, open_catalogue

pytestmark = pytest.mark.usefixtures("database")  # on SQLite and on PostgreSQL

NEW = make_vocabulary(2)
NEW_WORDS = {"hks-0": np.array([0.1, 0.2, 0.7], dtype=np.float32)}


@pytest.fixture
def opened(tmp_path: Path) -> Iterator[Opened]:
    opened = open_catalogue(tmp_path)
    opened.catalogue.add_vocabulary(NEW)
    yield opened
    opened.engine.dispose()


def test_the_active_vocabulary_comes_back_as_it_was(opened: Opened) -> None:
    active = opened.catalogue.active_vocabulary()
    assert active is not None
    assert active.id == opened.vocabulary_id == opened.catalogue.state().vocabulary_id
    assert active.to_bytes() == make_vocabulary().to_bytes()


def test_adding_a_known_vocabulary_again_changes_nothing(opened: Opened) -> None:
    opened.catalogue.add_vocabulary(NEW)
    opened.catalogue.add_vocabulary(make_vocabulary())
    assert opened.catalogue.state().vocabulary_id == opened.vocabulary_id


def test_a_vocabulary_is_refused_until_every_ready_shape_has_its_blocks(opened: Opened) -> None:
    for shape_id in "abc":
        add_ready(opened, shape_id)
    add_queued(opened, "waiting")
    before = opened.catalogue.state()
    for left in (["a", "b", "c"], ["b", "c"], ["c"]):
        assert opened.catalogue.missing_from(NEW.id, 10) == left
        assert not opened.catalogue.activate(NEW.id)
        opened.catalogue.add_quantised(left[0], NEW.id, NEW_WORDS)
    assert opened.catalogue.missing_from(NEW.id, 10) == []
    assert opened.catalogue.state() == before
    assert opened.catalogue.activate(NEW.id)
    after = opened.catalogue.state()
    assert (after.vocabulary_id, after.epoch) == (NEW.id, before.epoch + 1)
    assert after.revision > before.revision


def test_missing_shapes_are_told_up_to_a_limit(opened: Opened) -> None:
    for shape_id in "abc":
        add_ready(opened, shape_id)
    assert opened.catalogue.missing_from(NEW.id, 2) == ["a", "b"]
    assert opened.catalogue.missing_from(opened.vocabulary_id, 2) == []


def test_the_blocks_of_the_old_vocabulary_go_with_it(opened: Opened) -> None:
    add_ready(opened, "a")
    opened.catalogue.add_quantised("a", NEW.id, NEW_WORDS)
    assert opened.catalogue.activate(NEW.id)
    with reading(opened.engine) as session:
        assert session.scalars(select(func.count()).select_from(QuantisedBlockRow)).one() == 1
    assert set(opened.catalogue.blocks("a", opened.vocabulary_id)) == {"colour-histogram"}
    assert opened.catalogue.blocks("a", NEW.id)["hks-0"].size == 3


def test_activating_the_active_one_changes_nothing(opened: Opened) -> None:
    before = opened.catalogue.state()
    assert opened.catalogue.activate(opened.vocabulary_id)
    assert opened.catalogue.state() == before


def test_blocks_of_the_active_vocabulary_can_be_replaced_and_are_noticed(opened: Opened) -> None:
    add_ready(opened, "a")
    before = opened.catalogue.revision()
    opened.catalogue.add_quantised("a", NEW.id, NEW_WORDS)
    assert opened.catalogue.revision() == before  # no index shows them
    opened.catalogue.add_quantised("a", opened.vocabulary_id, {"hks-0": [0.5, 0.5]})
    assert opened.catalogue.changes_since(before).changed == ("a",)
    assert opened.catalogue.blocks("a", opened.vocabulary_id)["hks-0"].tolist() == [0.5, 0.5]


def test_fingerprints_are_never_mixed(opened: Opened) -> None:
    add_ready(opened, "a")
    foreign = make_vocabulary(3, fingerprint="of other parameters")
    opened.catalogue.add_vocabulary(foreign)
    with pytest.raises(FingerprintMismatch):
        opened.catalogue.add_quantised("a", foreign.id, NEW_WORDS)
    with pytest.raises(FingerprintMismatch):
        opened.catalogue.activate(foreign.id)
    opened.catalogue.remove("a")
    assert opened.catalogue.activate(foreign.id)


def test_what_is_unknown_or_not_ready_is_named(opened: Opened) -> None:
    add_queued(opened, "waiting")
    with pytest.raises(ShapeNotFound):
        opened.catalogue.add_quantised("nobody", NEW.id, NEW_WORDS)
    with pytest.raises(NotReady):
        opened.catalogue.add_quantised("waiting", NEW.id, NEW_WORDS)
    with pytest.raises(BadBlock):
        opened.catalogue.add_quantised("waiting", NEW.id, {})
    for call in (opened.catalogue.activate, lambda unknown: opened.catalogue.missing_from(unknown, 1)):
        with pytest.raises(UnknownVocabulary):
            call("v-unknown")


def test_readers_see_the_old_vocabulary_whole_or_the_new_one_whole(opened: Opened, tmp_path: Path) -> None:
    for number in range(30):
        add_ready(opened, f"s{number}")
        opened.catalogue.add_quantised(f"s{number}", NEW.id, NEW_WORDS)
    seen: set[tuple[int, ...]] = set()
    done = threading.Event()

    def read() -> None:
        while not done.is_set():
            state = opened.catalogue.state()
            rows = opened.catalogue.block_rows(state.vocabulary_id, names=["hks-0"])
            seen.add(tuple(sorted({blocks["hks-0"].size if blocks else 0 for _, blocks in rows})))

    reader = threading.Thread(target=read)
    reader.start()
    other = open_catalogue(tmp_path)
    assert other.catalogue.activate(NEW.id)
    done.set()
    reader.join()
    other.engine.dispose()
    assert seen <= {(2,), (3,), (0,)}  # 0: the state was read before the change, the rows after it
    assert {blocks["hks-0"].size for _, blocks in opened.catalogue.block_rows(NEW.id)} == {3}
