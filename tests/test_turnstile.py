"""A bounded number may be inside."""

import pytest

from service.http.turnstile import TooBusy, Turnstile


def test_one_more_than_the_places_is_refused_until_one_leaves() -> None:
    turnstile = Turnstile(2)
    with turnstile.enter():
        with turnstile.enter(), pytest.raises(TooBusy), turnstile.enter():
            pass
        with turnstile.enter():
            pass


def test_a_place_is_free_again_after_an_error() -> None:
    turnstile = Turnstile(1)
    with pytest.raises(KeyError), turnstile.enter():
        raise KeyError
    with turnstile.enter():
        pass
