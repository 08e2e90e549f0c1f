"""Plain lines are read as the slow readers read them, and odd ones are left to those."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from worker.reading.obj_lines import read_any, read_plain

WORD = st.sampled_from(
    ["v", "vt", "vn", "f", "#", "usemtl", "mtllib", "o", "s", "1", "-2", "3/4", "5//6", "7/8/9", "-1/-1"]
    + ["0", "0.5", "-.5", "1e3", "2.5E-3", "+7.", "a", "1/", "nan", "1.2.3", "--1", "#x", "vp", "1e", "-"]
)
LINES = st.lists(st.lists(WORD, max_size=7).map(" ".join), max_size=8).map("\n".join)


@given(LINES)
def test_what_is_plain_reads_as_ever(lines: str) -> None:
    plain = read_plain(lines.encode())
    if plain is None:
        return
    block = read_any(lines.encode(), 1)
    for name in ("positions", "colours", "uvs", "vertices_before", "uvs_before", "material_of"):
        np.testing.assert_array_equal(getattr(plain, name), getattr(block, name))
    for name in ("vertices", "uvs", "has_uv", "counts"):
        np.testing.assert_array_equal(getattr(plain.corners, name), getattr(block.corners, name))
    assert (plain.materials, plain.libraries) == (block.materials, block.libraries)


@pytest.mark.parametrize(
    "text",
    [
        "v 1 2 3\nv 1.5 -2.5e-3 3 0.1 0.2 0.3\nvt .5 1\nvn 0 0 1\nf 1/1/1 2//1 -1\n",
        "mtllib a b.mtl\nusemtl  red  \no x\n\n\t\ns off\n# v 1",
        "v 1 2 3",
    ],
)
def test_what_programs_write_is_plain(text: str) -> None:
    assert read_plain(text.encode()) is not None


@pytest.mark.parametrize(
    "text", ["v 1 2", "v 1 2 x", "f 1/2/3/4", "f a", "f 1/0", "vp 1 2", "vt", "v 1 2 3#", "f 1/ 2/ 3/"]
)
def test_what_is_odd_is_left_to_others(text: str) -> None:
    assert read_plain(text.encode()) is None
