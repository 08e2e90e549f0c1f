import numpy as np
import pytest

from index.errors import BadBlock
from index.layout import Layout
from index.methods import METHODS, Block, Method, with_weights

FUSED = Layout(method=METHODS["fused"], lengths=(64, 1600, 144))


def make_layout(power: int) -> Layout:
    blocks = (Block(name="a", weight=0.25, power=power), Block(name="b", weight=4.0, power=power))
    return Layout(method=Method(name="m", blocks=blocks, description=""), lengths=(1, 2))


def test_blocks_lie_side_by_side_in_the_order_of_the_method() -> None:
    blocks = {
        name: np.full(length, number, dtype=np.float32)
        for number, (name, length) in enumerate(
            [("colour-curves", 144), ("colour-histogram", 1600), ("log-hks", 64), ("other", 5)]
        )
    }
    assert Layout.of(METHODS["fused"], blocks) == FUSED
    row = FUSED.join(blocks)
    assert [row[place].tolist() for place in FUSED.slices] == [[2.0] * 64, [1.0] * 1600, [0.0] * 144]


def test_the_widest_block_is_not_scaled_and_only_the_others_are_rounded() -> None:
    places = FUSED.slices
    assert set(FUSED.scales[places[1]].tolist()) == {1.0}
    assert FUSED.scales[places[0]][0] == np.float32(1.87 / 0.587)
    assert FUSED.rounded.tolist() == [*range(64), *range(1664, 1808)]


@pytest.mark.parametrize(("power", "by_hand"), [(1, [8.5, 4.25]), (2, [17.0, 4.25])])
def test_distances_are_weighted_powers_of_the_blocks_distances(power: int, by_hand: list[float]) -> None:
    layout = make_layout(power)
    rows = np.array([[3, 2, -1], [0, 1, 1]], dtype=np.float32)  # from the query: 2 and 2, 1 and 1
    query = np.array([1, 1, 0], dtype=np.float32)
    assert layout.distances(rows, query, layout.method).tolist() == by_hand
    own = with_weights(layout.method, {"b": 0.0})
    assert layout.distances(rows, query, own).tolist() == [0.25 * 2**power, 0.25]


def test_a_rows_distance_does_not_depend_on_the_rows_beside_it() -> None:
    rows = np.random.default_rng(0).random((300, FUSED.width), dtype=np.float32)
    together = FUSED.distances(rows, rows[0], FUSED.method)
    alone = [float(FUSED.distances(row[None], rows[0], FUSED.method)[0]) for row in rows]
    assert together.tolist() == alone
    assert FUSED.distances(rows[::7], rows[0], FUSED.method).tolist() == alone[::7]


@pytest.mark.parametrize(
    ("blocks", "words"),
    [
        ({"a": [1.0]}, "needs the block 'b'"),
        ({"a": [1.0], "b": [1.0]}, "2 finite numbers"),
        ({"a": [[1.0]], "b": [1.0, 2.0]}, "1 finite numbers"),
        ({"a": [1.0], "b": [1.0, np.inf]}, "2 finite numbers"),
    ],
)
def test_blocks_that_do_not_fit_are_named(blocks: dict[str, list[float]], words: str) -> None:
    with pytest.raises(BadBlock, match=words):
        make_layout(1).join(blocks)
