"""Who holds a key is told without asking the database; in doubt the doors stay closed."""

import hmac
import logging
import threading
from collections.abc import Sequence

import pytest
from pydantic import SecretStr
from sqlalchemy.exc import OperationalError

from index.key_secrets import digest_of, make_secret
from index.keys import ActiveKey
from index.scopes import Scope
from service import key_ring
from service.key_ring import KeyRing, KeysUnreadable, Unauthorised
from service.settings import Settings
from tests.serving import wait_until

pytestmark = pytest.mark.usefixtures("database")  # on SQLite and on PostgreSQL

GIVEN = "a-long-secret"
ALONE = Settings(host="127.0.0.1")
FOR_OTHERS = Settings(host="0.0.0.0")  # noqa: S104 - nothing listens
TRUSTED = Settings(host="0.0.0.0", insecure=True)  # noqa: S104 - nothing listens
WITH_KEY = Settings(api_keys=(SecretStr(GIVEN),))


class Stored:
    """The keys of a library, without one."""

    def __init__(self) -> None:
        self.keys: list[ActiveKey] = []
        self.away = False  # whether the database fails
        self.looks = 0

    def add(self, scope: Scope = Scope.WRITE) -> bytes:
        """Make a key; return its secret."""
        key_id, secret = make_secret()
        self.keys.append(ActiveKey(id=key_id, digest=digest_of(secret.encode()), scope=scope))
        return secret.encode()

    def active(self) -> Sequence[ActiveKey]:
        """Do as the library's own would."""
        self.looks += 1
        if self.away:
            raise OperationalError("SELECT", {}, Exception("the database is away"))
        return tuple(self.keys)


@pytest.mark.parametrize("scope", Scope)
def test_a_stored_key_opens_for_what_it_allows(scope: Scope) -> None:
    stored = Stored()
    first, second = stored.add(scope), stored.add(scope)
    ring = KeyRing(ALONE, stored.active)
    holders = [ring.holder_of(secret) for secret in (first, second, first)]
    assert [holder and holder.scope for holder in holders] == [scope] * 3
    assert holders[0] == holders[2] != holders[1]


def test_a_key_of_the_environment_allows_everything_whatever_signs_it_has() -> None:
    settings = Settings(api_keys=(SecretStr(GIVEN), SecretStr("clé")))
    for secret in (GIVEN, "clé"):
        holder = KeyRing(settings, Stored().active).holder_of(secret.encode())
        assert holder is not None
        assert holder.scope is Scope.WRITE
        assert secret not in repr(holder)


def test_what_is_nearly_a_key_opens_nothing() -> None:
    stored = Stored()
    secret, other = stored.add(), stored.add()
    ring = KeyRing(WITH_KEY, stored.active)
    mixed = b"_".join([*secret.split(b"_", 2)[:2], other.split(b"_", 2)[2]])
    for wrong in (None, b"", secret[:-1], secret + b"x", secret.upper(), mixed, b"fa_", b"\xff", b"A" * 9999):
        with pytest.raises(Unauthorised, match="faience key create"):
            ring.holder_of(wrong)


def test_digests_are_compared_in_constant_time_and_as_often_for_unknown_keys(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    compared: list[tuple[bytes, bytes]] = []

    class Watched:
        @staticmethod
        def compare_digest(sent: bytes, known: bytes) -> bool:
            compared.append((sent, known))
            return hmac.compare_digest(sent, known)

    stored = Stored()
    secret = stored.add()
    ring = KeyRing(WITH_KEY, stored.active)
    monkeypatch.setattr(key_ring, "hmac", Watched)
    ring.holder_of(secret)
    for_known = len(compared)
    with pytest.raises(Unauthorised):
        ring.holder_of(b"unknown")
    assert for_known == 2  # the environment's, and the one of this id
    assert len(compared) == 2 * for_known
    assert {len(digest) for pair in compared for digest in pair} == {32}


def test_without_any_key_a_service_for_this_machine_alone_is_open() -> None:
    for settings in (ALONE, TRUSTED):
        ring = KeyRing(settings, Stored().active)
        assert not ring.demanded
        assert ring.holder_of(None) is None
        assert ring.holder_of(b"anything") is None


def test_the_first_key_closes_an_open_service() -> None:
    stored = Stored()
    ring = KeyRing(ALONE, stored.active)
    secret = stored.add()
    ring.look_again()
    assert ring.demanded
    assert ring.holder_of(secret) is not None
    with pytest.raises(Unauthorised):
        ring.holder_of(None)


@pytest.mark.parametrize("settings", [ALONE, TRUSTED, FOR_OTHERS, WITH_KEY])
def test_revoking_the_last_key_opens_nothing(settings: Settings) -> None:
    stored = Stored()
    secret = stored.add()
    ring = KeyRing(settings, stored.active)
    holder = ring.holder_of(secret)
    assert ring.welcomes(holder)
    stored.keys.clear()
    ring.look_again()
    assert not ring.welcomes(holder)
    for sent in (secret, None):
        with pytest.raises(Unauthorised):
            ring.holder_of(sent)


def test_a_service_for_others_is_closed_from_its_start_until_there_is_a_key() -> None:
    stored = Stored()
    ring = KeyRing(FOR_OTHERS, stored.active)
    with pytest.raises(Unauthorised):
        ring.holder_of(None)
    secret = stored.add()
    ring.look_again()
    assert ring.holder_of(secret) is not None


def test_whoever_came_in_without_a_key_is_not_welcome_once_keys_are_demanded() -> None:
    stored = Stored()
    ring = KeyRing(ALONE, stored.active)
    assert ring.welcomes(None)
    stored.add()
    ring.look_again()
    assert not ring.welcomes(None)
    given = KeyRing(WITH_KEY, Stored().active)
    assert given.welcomes(given.holder_of(GIVEN.encode()))


def test_while_the_database_is_away_the_last_keys_go_on(caplog: pytest.LogCaptureFixture) -> None:
    stored = Stored()
    secret = stored.add()
    ring = KeyRing(ALONE, stored.active)
    stored.away = True
    with caplog.at_level(logging.INFO):
        for _ in range(3):
            ring.look_again()
        assert ring.holder_of(secret) is not None
        with pytest.raises(Unauthorised):
            ring.holder_of(None)
        stored.away = False
        ring.look_again()
    assert len(caplog.records) == 2  # that it went, and that it is back: not every second
    assert secret.decode() not in caplog.text


def test_when_it_is_away_for_too_long_only_keys_of_the_environment_open() -> None:
    stored = Stored()
    secret = stored.add()
    stale = KeyRing(WITH_KEY, stored.active, patience=-1)
    assert stale.holder_of(GIVEN.encode()) is not None
    for sent in (secret, b"unknown", None):
        with pytest.raises(KeysUnreadable):
            stale.holder_of(sent)


def test_an_open_service_closes_when_it_cannot_know_of_keys_any_more() -> None:
    with pytest.raises(KeysUnreadable):
        KeyRing(ALONE, Stored().active, patience=-1).holder_of(None)


def test_the_first_look_must_succeed() -> None:
    stored = Stored()
    stored.away = True
    with pytest.raises(OperationalError):
        KeyRing(ALONE, stored.active)


def test_it_looks_again_beside_the_block_survives_failures_and_ends_with_it() -> None:
    stored = Stored()
    ring = KeyRing(ALONE, stored.active)
    with ring.watching(every=0.01):
        stored.away = True
        seen = stored.looks
        wait_until(lambda: stored.looks > seen + 2)
        secret = stored.add()
        stored.away = False
        wait_until(lambda: ring.demanded)
        assert ring.holder_of(secret) is not None
    assert "keys" not in {thread.name for thread in threading.enumerate()}


def test_a_request_asks_the_database_nothing() -> None:
    stored = Stored()
    secret = stored.add()
    ring = KeyRing(ALONE, stored.active)
    for _ in range(100):
        ring.holder_of(secret)
    assert stored.looks == 1
