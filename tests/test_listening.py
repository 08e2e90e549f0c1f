"""Other machines are let in by a key or by an explicit word only."""

from pathlib import Path

import pytest
from pydantic import SecretStr

from index.database import make_engine
from index.keys import Keys
from index.migrating import migrate
from index.scopes import Scope
from service.listening import UnsafeListening, check_listening
from service.settings import Settings

HOSTS = ["0.0.0.0", "::", "192.168.1.5", "example.org", ""]  # noqa: S104 - none is listened on


def made_keys(settings: Settings) -> Keys:
    """Return the keys of a new library."""
    settings.data_dir.mkdir()
    engine = make_engine(settings.url)
    migrate(engine)
    return Keys(engine)


@pytest.mark.parametrize("host", ["127.0.0.1", "127.8.8.8", "::1", "[::1]", "localhost"])
def test_loopback_needs_no_key(host: str, tmp_path: Path) -> None:
    check_listening(Settings(host=host, data_dir=tmp_path / "library"))


@pytest.mark.parametrize("host", HOSTS)
def test_other_machines_are_let_in_with_a_key_or_by_an_explicit_word_only(host: str, tmp_path: Path) -> None:
    folder = tmp_path / "library"
    with pytest.raises(UnsafeListening, match="faience key create") as refusal:
        check_listening(Settings(host=host, data_dir=folder))
    assert "FAIENCE_API_KEYS" in str(refusal.value)
    check_listening(Settings(host=host, data_dir=folder, api_keys=(SecretStr("key"),)))
    check_listening(Settings(host=host, data_dir=folder, insecure=True))
    assert not folder.exists()  # asking made nothing


def test_a_key_of_the_library_lets_others_in_until_it_is_revoked(tmp_path: Path) -> None:
    settings = Settings(host=HOSTS[0], data_dir=tmp_path / "library")
    keys = made_keys(settings)
    with pytest.raises(UnsafeListening):
        check_listening(settings)
    key, _ = keys.create("loan desk", Scope.READ)
    check_listening(settings)
    keys.revoke(key.id)
    with pytest.raises(UnsafeListening):
        check_listening(settings)
