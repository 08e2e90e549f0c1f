import math

import pytest

from index.errors import BadWeights, UnknownMethod
from index.methods import DEFAULT_METHOD, METHODS, method, with_weights


def test_the_table_holds_the_methods_of_the_design() -> None:
    terms = {
        name: [(block.name, block.weight, block.power) for block in row.blocks]
        for name, row in METHODS.items()
    }
    assert terms == {
        "fused": [
            ("log-hks", 1 / 0.587, 1),
            ("colour-histogram", 1 / 1.83, 1),
            ("colour-curves", 1 / 150.5, 1),
        ],
        "chks": [("hks-0", 1.0, 2), ("hks-0.05", 0.05, 2), ("hks-0.1", 0.1, 2)],
        "hks": [("hks-0", 1.0, 1)],
        "diffusion": [("diffusion-geometric", 1.0, 1)],
        "colour-diffusion": [("diffusion-joint", 1.0, 1)],
        "colour-histogram": [("colour-histogram", 1.0, 1)],
        "meshhog": [("meshhog", 1.0, 1)],
    }
    assert DEFAULT_METHOD == "fused"


@pytest.mark.parametrize("name", METHODS)
def test_rows_keep_what_the_search_relies_on(name: str) -> None:
    row = METHODS[name]
    assert row.name == name
    assert {block.power for block in row.blocks} == {row.power} <= {1, 2}
    assert all(block.weight > 0 for block in row.blocks)


def test_a_method_is_found_by_its_exact_name() -> None:
    assert method("chks") is METHODS["chks"]
    with pytest.raises(UnknownMethod, match="fused"):
        method("Fused")


def test_own_weights_replace_those_they_name() -> None:
    weighed = with_weights(METHODS["chks"], {"hks-0": 0, "hks-0.1": 2.5})
    assert [block.weight for block in weighed.blocks] == [0, 0.05, 2.5]
    assert weighed.power == 2
    assert with_weights(METHODS["chks"], {}) == METHODS["chks"]


@pytest.mark.parametrize(
    ("weights", "words"),
    [
        ({"colour-curves": 1.0}, "no block 'colour-curves'"),
        ({"hks-0": -0.1}, "from 0 to"),
        ({"hks-0": math.nan}, "from 0 to"),
        ({"hks-0": math.inf}, "from 0 to"),
        ({"hks-0": 1e308}, "from 0 to"),
        ({"hks-0": 0.0, "hks-0.05": 0.0, "hks-0.1": 0.0}, "at least one"),
    ],
)
def test_weights_without_meaning_are_refused(weights: dict[str, float], words: str) -> None:
    with pytest.raises(BadWeights, match=words):
        with_weights(METHODS["chks"], weights)
