from dataclasses import replace

import numpy as np
import pytest

from index.errors import BadBlock
from index.layout import Layout
from index.methods import METHODS, with_weights
from index.packing import PACKINGS
from tests.layouts import make_method, single_layout

LENGTHS = {"log-hks": 6, "colour-histogram": 9, "colour-curves": 4}
FUSED = Layout(method=METHODS["fused"], lengths=tuple(LENGTHS.values()))


def test_blocks_lie_side_by_side_in_the_order_of_the_method() -> None:
    layout = single_layout(1, (3, 2))
    blocks = {"b1": np.array([4, 5]), "other": np.ones(7), "b0": np.array([1, 2, 3])}
    row = layout.join(blocks)
    assert row.dtype == np.float32
    assert row.tolist() == [1.0, 2.0, 3.0, 4.0, 5.0]
    assert layout.edges.tolist() == [0, 3, 5]
    assert layout.width == 5


def test_packed_blocks_lie_there_as_their_bytes() -> None:
    generator = np.random.default_rng(0)
    blocks = {name: generator.random(length, dtype=np.float32) for name, length in LENGTHS.items()}
    assert Layout.of(METHODS["fused"], blocks) == FUSED
    row = FUSED.join(blocks)
    assert row.dtype == np.uint8
    expected = [PACKINGS[name].pack(block) for name, block in blocks.items()]
    np.testing.assert_array_equal(row, np.concatenate(expected))


def test_one_block_of_single_numbers_makes_the_whole_row_one_of_single_numbers() -> None:
    layout = Layout(method=make_method(1, [1.0, 2.0], ["log-hks", "hks-0"]), lengths=(2, 1))
    assert layout.packings is None
    row = layout.join({"log-hks": [0.1, 0.2], "hks-0": [3.0]})
    np.testing.assert_array_equal(row, np.array([0.1, 0.2, 3.0], np.float32))  # nothing is rounded
    assert layout.units.tolist() == [1.0, 1.0]
    assert not layout.squared.any()


@pytest.mark.parametrize("power", [1, 2])
def test_weights_bring_sums_of_whole_units_to_the_distance(power: int) -> None:
    blocks = [replace(block, power=power) for block in METHODS["fused"].blocks]
    method = replace(METHODS["fused"], blocks=tuple(blocks))
    own = with_weights(method, {"log-hks": 0.0, "colour-curves": 2.0})
    layout = Layout(method=method, lengths=FUSED.lengths)
    units = (1 / 255**2, 1 / 255**2, 1 / 13)
    by_hand = [weight * unit**power for weight, unit in zip((0.0, 1 / 1.83, 2.0), units, strict=True)]
    np.testing.assert_allclose(layout.weights(own), by_hand, rtol=1e-15)
    assert layout.squared.tolist() == [True, True, False]


def test_a_row_is_written_into_the_memory_that_is_given() -> None:
    layout = single_layout(1, (1, 2))
    rows = np.zeros((2, 3), np.float32)
    layout.join({"b0": [1.0], "b1": [2.0, 3.0]}, out=rows[1])
    assert rows.tolist() == [[0.0, 0.0, 0.0], [1.0, 2.0, 3.0]]


@pytest.mark.parametrize(
    ("blocks", "words"),
    [
        ({"b0": [1.0]}, "needs the block 'b1'"),
        ({"b0": [1.0], "b1": [1.0]}, "2 finite numbers"),
        ({"b0": [[1.0]], "b1": [1.0, 2.0]}, "1 finite numbers"),
        ({"b0": [1.0], "b1": [1.0, np.inf]}, "2 finite numbers"),
        ({"b0": [1.0], "b1": [1.0, np.nan]}, "2 finite numbers"),
    ],
)
def test_blocks_that_do_not_fit_are_named(blocks: dict[str, list[float]], words: str) -> None:
    with pytest.raises(BadBlock, match=words):
        single_layout(1, (1, 2)).join(blocks)
