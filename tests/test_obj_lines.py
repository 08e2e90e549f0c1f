"""Lines of an OBJ file are told apart by their keyword."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from worker.errors import Code, MeshError
from worker.reading.obj_lines import is_obj, read_block


def test_a_block_knows_what_stood_above_each_face() -> None:
    block = read_block(b"v 0 0 0\nf 1 1 1\nvt 0 0\nusemtl a b\nv 1 1 1\n# f 9 9 9\nf -1 -1 -1\n", 1)
    assert block.vertices_before.tolist() == [1, 2]
    assert block.uvs_before.tolist() == [0, 1]
    assert block.materials == ("a b",)
    assert block.material_of.tolist() == [-1, 0]


def test_blanks_tabs_and_comments_change_nothing() -> None:
    plain = read_block(b"v 1 2 3\nvt 4 5\nf 1 1 1\n", 1)
    odd = read_block(b"  \tv\t1  2 3 # 7 8 9\n\n \nvt 4 5 #\n f 1\t1 1 #f 2\n", 1)
    np.testing.assert_array_equal(odd.positions, plain.positions)
    np.testing.assert_array_equal(odd.uvs, plain.uvs)
    assert odd.corners.counts.tolist() == plain.corners.counts.tolist() == [3]


def test_four_or_five_numbers_hold_no_colour_six_do() -> None:
    block = read_block(b"v 1 2 3 1\nv 1 2 3 4 5\nv 1 2 3 .4 .5 .6\nv 1 2 3 .4 .5 .6 1\n", 1)
    assert np.isnan(block.colours[:2]).all()
    assert block.colours[2:].tolist() == [[0.4, 0.5, 0.6]] * 2


def test_a_texture_coordinate_of_one_number_has_zero_for_the_other() -> None:
    assert read_block(b"vt .5\n", 1).uvs.tolist() == [[0.5, 0.0]]


def test_words_like_keywords_are_none() -> None:
    block = read_block(b"vertex 1 2 3\nfoo 1 2 3\nmtllibrary x\nvt2 1 1\n", 1)
    assert len(block.positions) == len(block.uvs) == block.corners.counts.size == len(block.libraries) == 0
    assert not is_obj(block.keywords)


def test_keywords_longer_than_eight_bytes_do_not_pass_for_shorter_ones() -> None:
    assert read_block(b"usemtlusemtl a\n", 1).materials == ()


@pytest.mark.parametrize("line", ["v", "v 1 2", "vt", "v # 1 2 3"])
def test_a_line_with_too_few_numbers_is_refused_by_its_number(line: str) -> None:
    with pytest.raises(MeshError, match="Line 12") as caught:
        read_block(f"v 0 0 0\n{line}\n".encode(), 11)
    assert caught.value.code == Code.BAD_DATA


@given(st.lists(st.tuples(st.floats(-1e9, 1e9), st.floats(-1e9, 1e9), st.floats(-1e9, 1e9)), max_size=20))
def test_positions_survive_to_the_last_bit(points: list[tuple[float, float, float]]) -> None:
    text = "".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in points)
    assert read_block(text.encode(), 1).positions.tolist() == [list(point) for point in points]
