import numpy as np
import pytest

from index import gathering, vectors
from index.errors import BadBlock
from index.gathering import gather, put_all
from index.methods import METHODS
from index.stored_blocks import Blocks

CHKS = METHODS["chks"]


def make_blocks(number: int, length: int = 2) -> Blocks:
    return {block.name: np.full(length, number, dtype=np.float32) for block in CHKS.blocks}


def test_shapes_come_in_pieces_and_incomplete_ones_not_at_all(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(gathering, "_CHUNK", 2)
    rows = [(f"s{number}", make_blocks(number)) for number in range(5)]
    del rows[1][1]["hks-0"]
    pieces = list(gather(rows, CHKS))
    assert [ids for _, ids, _ in pieces] == [["s0", "s2"], ["s3", "s4"]]
    assert [rows[:, 0].tolist() for _, _, rows in pieces] == [[0.0, 2.0], [3.0, 4.0]]
    assert {layout.lengths for layout, _, _ in pieces} == {(2, 2, 2)}


def test_a_block_of_another_length_is_refused() -> None:
    with pytest.raises(BadBlock, match="2 finite numbers"):
        list(gather([("a", make_blocks(1)), ("b", make_blocks(1, length=3))], CHKS))


def test_pieces_add_up_and_no_pieces_make_no_vectors() -> None:
    assert put_all(gather([], CHKS)) is None
    first = put_all(gather([("a", make_blocks(1))], CHKS))
    both = put_all(gather([("b", make_blocks(2)), ("a", make_blocks(3))], CHKS), first)
    assert both is first
    assert both is not None
    assert sorted(both.ids[position] for position in both.here) == ["a", "b"]
    assert both.rows[both.positions(["a"])].tolist() == [[3.0] * 6]
    assert put_all(gather([], CHKS), first) is first


def test_rows_are_kept_as_their_layout_says() -> None:
    blocks = {block.name: np.array([0.25, 0.5], np.float32) for block in METHODS["fused"].blocks}
    (layout, _, rows) = next(gather([("a", blocks)], METHODS["fused"]))
    assert rows.dtype == np.uint8
    np.testing.assert_array_equal(rows[0], layout.join(blocks))


def test_many_rows_are_settled_once_all_are_there(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(vectors, "SKETCHED", 20)
    monkeypatch.setattr(gathering, "_CHUNK", 8)
    found = put_all(gather([(f"s{number:02}", make_blocks(number)) for number in range(30)], CHKS))
    assert found is not None
    assert found.sketch is not None
    assert found.sketch.size == 30
    assert sorted(found.ids) == [f"s{number:02}" for number in range(30)]
