import multiprocessing
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from sqlalchemy import event

from index.errors import (
    BadBlock,
    BadWeights,
    StorageFull,
    UnknownMethod,
    VocabularyChanged,
)
from index.local_files import LocalFiles
from index.methods import METHODS, with_weights
from tests.brute_force import (
    METHOD_NAMES,
    PLAIN,
    Blocks,
    add,
    add_in_process,
    agrees,
    brute_force,
    make_blocks,
)
from tests.catalogues import (
    Opened,
    add_queued,
    add_ready,
    make_searcher,
    make_vocabulary,
    open_catalogue,
)
from tests.databases import only_in_memory, only_in_memory_on_sqlite
from tests.saved_indexes import flipped, saved_index

pytestmark = pytest.mark.usefixtures("indexed")  # in memory, on SQLite and on PostgreSQL, and in pgvector


@pytest.fixture
def opened(tmp_path: Path) -> Iterator[Opened]:
    opened = open_catalogue(tmp_path)
    yield opened
    opened.engine.dispose()


def test_every_method_answers_as_brute_force_over_the_catalogue(opened: Opened, tmp_path: Path) -> None:
    for number in range(70):
        add(opened, number)
    searcher = make_searcher(opened, tmp_path / "index")
    for limit in (1, 10, 69, 500):
        assert agrees(searcher, opened, limit)


def test_own_weights_and_exclusions_are_respected(opened: Opened, tmp_path: Path) -> None:
    for number in range(60):
        add(opened, number)
    searcher = make_searcher(opened, tmp_path)
    query, weights = make_blocks(98), {"log-hks": 0.0, "colour-curves": 2.5}
    method = with_weights(METHODS["fused"], weights)
    everything = brute_force(opened, method, query, 60)
    assert searcher.search("fused", query, 9, weights=weights) == everything[:9]
    hidden = {shape_id for shape_id, _ in everything[:20]}
    answer = searcher.search("fused", query, 9, weights=weights, exclude=hidden)
    assert answer == everything[20:29]
    default = {block.name: block.weight for block in METHODS["fused"].blocks}
    assert searcher.search("fused", query, 9, weights=default) == searcher.search("fused", query, 9)


def test_changes_by_another_catalogue_are_seen_by_the_next_search(opened: Opened, tmp_path: Path) -> None:
    searcher = make_searcher(opened, tmp_path / "index")
    other = open_catalogue(tmp_path)
    assert agrees(searcher, opened)  # empty
    for number in range(12):
        add(other, number)
        assert agrees(searcher, opened)
    other.catalogue.remove("s0003")
    assert "s0003" not in dict(searcher.search("hks", make_blocks(3), 50))
    other.catalogue.update("s0005", name="new")
    add_queued(other, "waiting")
    assert agrees(searcher, opened, 50)
    other.catalogue.remove("s0004")
    add_ready_again = open_catalogue(tmp_path)
    other.catalogue.remove("waiting")
    add(add_ready_again, 4)
    assert agrees(searcher, opened, 50)
    for each in (other, add_ready_again):
        each.engine.dispose()


def test_changes_by_another_process_are_seen_by_the_next_search(opened: Opened, tmp_path: Path) -> None:
    add(opened, 0)
    searcher = make_searcher(opened, tmp_path / "index")
    assert agrees(searcher, opened)
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as processes:
        processes.submit(add_in_process, tmp_path, [1, 2, 3]).result()
    assert agrees(searcher, opened)
    assert len(searcher.search("hks", make_blocks(1), 9)) == 4


@only_in_memory_on_sqlite
def test_a_searcher_with_nothing_new_costs_one_select(opened: Opened, tmp_path: Path) -> None:
    for number in range(5):
        add(opened, number)
    searcher = make_searcher(opened, tmp_path / "index")
    searcher.search("fused", make_blocks(1), 3)
    statements: list[str] = []
    event.listen(opened.engine, "checkout", lambda taken, *_: taken.set_trace_callback(statements.append))
    searcher.search("fused", make_blocks(2), 3)
    assert [statement.split()[0] for statement in statements] == ["BEGIN", "SELECT", "ROLLBACK"]


@only_in_memory
def test_a_saved_index_is_used_again_and_completed(
    opened: Opened, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    saved_index(opened, tmp_path / "index")
    opened.catalogue.remove("s0002")
    opened.catalogue.update("s0003", name="new")
    add(opened, 90)
    read: list[str] = []
    block_rows = opened.catalogue.block_rows

    def watched(*told: object, **named: object) -> Iterator[tuple[str, Blocks]]:
        for shape_id, blocks in block_rows(*told, **named):  # type: ignore[arg-type]
            read.append(shape_id)
            yield shape_id, blocks

    monkeypatch.setattr(opened.catalogue, "block_rows", watched)
    searcher = make_searcher(opened, tmp_path / "index")
    answer = searcher.search("fused", make_blocks(99), 50)
    assert read == ["s0003", "s0090"]  # all others came from the file
    assert answer == brute_force(opened, METHODS["fused"], make_blocks(99), 50)


@only_in_memory
@pytest.mark.parametrize(
    "damage",
    [flipped, lambda data: data[:-4], lambda data: data[:20], lambda _: b"", lambda data: data + b"\0"],
    ids=["flipped", "truncated", "cut in its first line", "empty", "longer"],
)
def test_a_damaged_index_is_noticed_built_anew_and_replaced(
    opened: Opened, tmp_path: Path, damage: Callable[[bytes], bytes]
) -> None:
    path = saved_index(opened, tmp_path / "index")
    whole = path.read_bytes()
    path.write_bytes(damage(whole))
    searcher = make_searcher(opened, tmp_path / "index")
    assert agrees(searcher, opened, 50)
    assert path.read_bytes() == whole


def test_an_index_of_another_library_is_not_believed(opened: Opened, tmp_path: Path) -> None:
    saved_index(opened, tmp_path / "index", 20)
    (tmp_path / "other").mkdir()
    other = open_catalogue(tmp_path / "other")
    for number in range(20):
        add(other, 5 * number)  # the same number of shapes and the same revision
    assert other.catalogue.revision() == opened.catalogue.revision()
    assert agrees(make_searcher(other, tmp_path / "index"), other, 50)
    other.engine.dispose()


@only_in_memory_on_sqlite
def test_an_index_newer_than_a_restored_catalogue_is_not_believed(tmp_path: Path) -> None:
    """The catalogue is put back from a copy, then grows beyond the index's revision in another way."""
    lost = open_catalogue(tmp_path)
    for number in range(5):
        add(lost, number)
    lost.engine.dispose()
    copy = (tmp_path / "catalogue.db").read_bytes()  # closed: nothing is left in the write-ahead log
    lost = open_catalogue(tmp_path)
    saved_index_of = make_searcher(lost, tmp_path / "index")
    for number in range(5, 9):
        add(lost, number)
    lost.catalogue.remove("s0001")
    assert agrees(saved_index_of, lost, 50)
    saved_index_of.close()
    lost.engine.dispose()
    (tmp_path / "catalogue.db").write_bytes(copy)
    restored = open_catalogue(tmp_path)
    for number in range(20, 30):
        add(restored, number)
    assert agrees(make_searcher(restored, tmp_path / "index"), restored, 50)
    restored.engine.dispose()


def test_another_vocabulary_makes_every_index_anew(opened: Opened, tmp_path: Path) -> None:
    saved_index(opened, tmp_path / "index", 20)
    running = make_searcher(opened, tmp_path / "index")
    before = running.search("fused", make_blocks(3), 20, vocabulary_id=opened.vocabulary_id)
    new = make_vocabulary(2)
    opened.catalogue.add_vocabulary(new)
    for shape_id in opened.catalogue.missing_from(new.id, 100):
        words = {
            name: block for name, block in make_blocks(int(shape_id[1:]) + 50).items() if name not in PLAIN
        }
        opened.catalogue.add_quantised(shape_id, new.id, words)
    assert running.search("fused", make_blocks(3), 20, vocabulary_id=opened.vocabulary_id) == before
    assert opened.catalogue.activate(new.id)
    with pytest.raises(VocabularyChanged):
        running.search("fused", make_blocks(3), 20, vocabulary_id=opened.vocabulary_id)
    assert running.search("fused", make_blocks(3), 20, vocabulary_id=new.id) != before
    for searcher in (running, make_searcher(opened, tmp_path / "index")):
        assert agrees(searcher, opened, 50)


def test_searching_while_others_write_is_safe_and_never_behind(opened: Opened, tmp_path: Path) -> None:
    for number in range(40):
        add(opened, number)
    searcher = make_searcher(opened, tmp_path / "index")
    writing = threading.Event()
    writing.set()

    def search(seed: int) -> int:
        rounds = 0
        while writing.is_set() or not rounds:
            kept = {f"s{number:04}" for number in range(20)}  # never removed
            answer = searcher.search(METHOD_NAMES[seed % 4], make_blocks(seed), 10_000)
            assert kept <= {shape_id for shape_id, _ in answer}
            assert answer == sorted(answer, key=lambda pair: (pair[1], pair[0]))
            rounds += 1
        return rounds

    def write() -> None:
        try:
            for number in range(40, 60):
                added = add(opened, number)
                assert added in dict(searcher.search("hks", make_blocks(1), 10_000))
                removed = f"s{number - 20:04}"
                opened.catalogue.remove(removed)
                assert removed not in dict(searcher.search("hks", make_blocks(1), 10_000))
        finally:
            writing.clear()

    with ThreadPoolExecutor(5) as threads:
        searching = [threads.submit(search, seed) for seed in range(4)]
        threads.submit(write).result()
        assert all(future.result() for future in searching)
    assert agrees(searcher, opened, 100)


def test_searchers_of_several_processes_share_a_folder(opened: Opened, tmp_path: Path) -> None:
    first, second = (make_searcher(opened, tmp_path / "index") for _ in range(2))
    for number in range(10):
        add(opened, number)
        assert agrees(first, opened)
        assert agrees(second, opened)
        (first if number % 2 else second).save()
    assert agrees(make_searcher(opened, tmp_path / "index"), opened, 50)


@only_in_memory
def test_a_full_disk_costs_no_answer(opened: Opened, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for number in range(5):
        add(opened, number)

    def full(*_: object) -> int:
        raise StorageFull("full")

    monkeypatch.setattr(LocalFiles, "write", full)
    searcher = make_searcher(opened, tmp_path / "index")
    assert agrees(searcher, opened)
    with pytest.raises(StorageFull):  # who asks for saving is told
        searcher.save()


def test_shapes_that_lack_a_block_are_left_out(opened: Opened, tmp_path: Path) -> None:
    add(opened, 1)
    blocks = make_blocks(2)
    add_ready(opened, "half", {}, {"hks-0": blocks["hks-0"]})
    searcher = make_searcher(opened, tmp_path)
    assert {shape_id for shape_id, _ in searcher.search("hks", blocks, 9)} == {"half", "s0001"}
    assert {shape_id for shape_id, _ in searcher.search("fused", blocks, 9)} == {"s0001"}


def test_wrong_questions_are_named(opened: Opened, tmp_path: Path) -> None:
    add(opened, 1)
    searcher = make_searcher(opened, tmp_path)
    blocks = make_blocks(1)
    with pytest.raises(UnknownMethod, match="fused"):
        searcher.search("best", blocks, 5)
    with pytest.raises(BadWeights):
        searcher.search("hks", blocks, 5, weights={"hks-0": -1.0})
    with pytest.raises(BadBlock, match="log-hks"):
        searcher.search("fused", {"hks-0": blocks["hks-0"]}, 5)
    with pytest.raises(BadBlock, match="4 finite numbers"):
        searcher.search("hks", {"hks-0": np.ones(5)}, 5)
    with pytest.raises(BadBlock):
        searcher.search("hks", {"hks-0": np.array([1.0, np.nan, 1.0, 1.0])}, 5)
