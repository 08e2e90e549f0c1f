import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from index.blocks import block_length, checked_blocks, decode_block, encode_block
from index.errors import BadBlock


@given(
    block=arrays(
        np.float32, st.integers(1, 300), elements=st.floats(width=32, allow_nan=False, allow_infinity=False)
    )
)
def test_a_block_comes_back_bit_for_bit(block: npt.NDArray[np.float32]) -> None:
    data = encode_block(block)
    assert decode_block(data).tobytes() == block.tobytes()
    assert block_length(data) == block.size


def test_a_mostly_empty_block_is_packed_and_a_full_one_hardly_larger_than_itself() -> None:
    generator = np.random.default_rng(1)
    full = generator.random(1600, dtype=np.float32)
    sparse = np.where(np.arange(1600) % 3 == 0, full, np.float32(0))
    assert len(encode_block(sparse)) < 0.5 * sparse.nbytes
    assert len(encode_block(full)) <= full.nbytes + 5


def test_a_block_whose_bytes_were_cut_is_refused() -> None:
    data = encode_block(np.random.default_rng(1).random(10, dtype=np.float32))
    with pytest.raises(BadBlock):
        decode_block(data[:-4])


@pytest.mark.parametrize("bad", [[np.nan], [np.inf], [1e39], [], [[1.0]], 3.0])
def test_what_no_distance_can_be_taken_of_is_refused(bad: npt.ArrayLike) -> None:
    with pytest.raises(BadBlock, match="'b'"):
        checked_blocks({"a": [1.0], "b": bad})


def test_numbers_of_any_kind_become_single_precision() -> None:
    checked = checked_blocks({"a": [1, 2], "b": np.ones(3)})
    assert {name: (block.dtype, block.shape) for name, block in checked.items()} == {
        "a": (np.dtype("f4"), (2,)),
        "b": (np.dtype("f4"), (3,)),
    }
