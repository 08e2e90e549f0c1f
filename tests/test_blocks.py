import struct
import zlib

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from index.blocks import block_length, checked_blocks, decode_block, encode_block
from index.errors import BadBlock
from index.packing import PACKINGS, Packing, rounded

ANY = arrays(
    np.float32, st.integers(1, 300), elements=st.floats(width=32, allow_nan=False, allow_infinity=False)
)


@given(block=ANY)
def test_a_block_without_a_packing_comes_back_bit_for_bit(block: npt.NDArray[np.float32]) -> None:
    data = encode_block("hks-0", block)
    assert decode_block(data).tobytes() == block.tobytes()
    assert block_length(data) == block.size


@pytest.mark.parametrize("name", PACKINGS)
@given(block=ANY)
def test_a_packed_block_comes_back_as_it_is_compared(name: str, block: npt.NDArray[np.float32]) -> None:
    data = encode_block(name, block)
    found = decode_block(data)
    assert (found.dtype.str, found.flags.writeable) == ("<f4", False)
    assert found.tobytes() == rounded(name, block).tobytes()
    assert block_length(data) == block.size
    assert encode_block(name, found) == data  # what was kept once does not change again
    assert len(data) <= block.size + 14


def test_a_stored_block_does_not_change_with_the_table(monkeypatch: pytest.MonkeyPatch) -> None:
    block = np.linspace(-2.0, 2.0, 50, dtype=np.float32)
    data = encode_block("colour-curves", block)
    before = decode_block(data)
    monkeypatch.setitem(PACKINGS, "colour-curves", Packing(squared=True, unit=0.5))
    np.testing.assert_array_equal(decode_block(data), before)


@pytest.mark.parametrize("compress", [False, True])
def test_blocks_of_earlier_versions_are_read(compress: bool) -> None:
    block = np.repeat(np.array([0.0, 0.3, 1e30], np.float32), 40)
    body = block.astype("<f4").tobytes()
    data = struct.pack("<BI", int(compress), 120) + (zlib.compress(body) if compress else body)
    assert decode_block(data).tobytes() == block.tobytes()


def test_a_mostly_empty_block_is_packed_and_a_full_one_hardly_larger_than_itself() -> None:
    generator = np.random.default_rng(1)
    full = generator.random(1600, dtype=np.float32)
    sparse = np.where(np.arange(1600) % 3 == 0, full, np.float32(0))
    assert len(encode_block("hks-0", sparse)) < 0.5 * sparse.nbytes
    assert len(encode_block("hks-0", full)) <= full.nbytes + 5
    assert len(encode_block("colour-histogram", sparse)) < 0.6 * sparse.size


@pytest.mark.parametrize("name", ["hks-0", "colour-histogram"])
def test_a_block_whose_bytes_were_cut_is_refused(name: str) -> None:
    data = encode_block(name, np.random.default_rng(1).random(10, dtype=np.float32))
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


def test_what_hardly_shrinks_is_not_compressed() -> None:
    landmarks = np.random.default_rng(0).normal(size=2560).astype(np.float32)  # their exponents repeat
    assert len(zlib.compress(landmarks.tobytes())) < landmarks.nbytes
    assert encode_block("landmarks", landmarks)[5:] == landmarks.tobytes()


def test_a_block_never_unpacks_to_more_than_its_header_says() -> None:
    whole = encode_block("b", np.zeros(1000, dtype=np.float32))
    bomb = whole[:5] + zlib.compress(bytes(1 << 24))
    for data in (bomb, whole[:-3]):
        with pytest.raises(BadBlock, match="unpack"):
            decode_block(data)
