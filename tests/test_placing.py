"""Methods whose blocks have no places are refused in words."""

import pytest

from index.methods import METHODS, method, with_weights
from service.why.errors import NotExplained
from service.why.placing import NOWHERE, check_places
from service.why.scale import USUAL
from tests.painted import PLACED_METHODS


@pytest.mark.parametrize("name", sorted(set(METHODS) - set(PLACED_METHODS)))
def test_what_compares_pairs_or_features_is_refused_by_its_name(name: str) -> None:
    with pytest.raises(NotExplained, match=f"'{name}'.*no one place"):
        check_places(method(name))


@pytest.mark.parametrize("name", PLACED_METHODS)
def test_the_others_are_not(name: str) -> None:
    check_places(method(name))
    check_places(with_weights(method(name), {method(name).blocks[0].name: 2.0}))


def test_every_block_has_places_or_a_reason_why_not() -> None:
    blocks = {block.name for each in METHODS.values() for block in each.blocks}
    assert blocks == set(USUAL) | set(NOWHERE)
    assert not set(USUAL) & set(NOWHERE)
