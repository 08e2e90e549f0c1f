"""Settings come from the environment, and closed doors stay closed."""

from pathlib import Path

import pytest
from pydantic import SecretStr

from service.settings import Settings, UnsafeListening, is_loopback


def test_settings_are_read_from_the_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FAIENCE_DATA_DIR", "elsewhere")
    monkeypatch.setenv("FAIENCE_API_KEYS", "first, second,")
    settings = Settings()
    assert settings.data_dir == Path("elsewhere")
    assert [key.get_secret_value() for key in settings.api_keys] == ["first", "second"]
    assert len(set(settings.key_digests)) == 2


def test_keys_do_not_show_when_settings_are_printed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FAIENCE_API_KEYS", "tell-nobody")
    assert "tell-nobody" not in repr(Settings())


@pytest.mark.parametrize("host", ["127.0.0.1", "127.8.8.8", "::1", "[::1]", "localhost"])
def test_loopback_needs_no_key(host: str) -> None:
    assert is_loopback(host)
    Settings(host=host).check_listening()


@pytest.mark.parametrize("host", ["0.0.0.0", "::", "192.168.1.5", "example.org", ""])  # noqa: S104
def test_other_machines_are_let_in_with_a_key_or_by_an_explicit_word_only(host: str) -> None:
    with pytest.raises(UnsafeListening, match="FAIENCE_API_KEYS"):
        Settings(host=host).check_listening()
    Settings(host=host, api_keys=(SecretStr("key"),)).check_listening()
    Settings(host=host, insecure=True).check_listening()


def test_the_catalogue_is_inside_the_data_folder_unless_a_database_is_named(tmp_path: Path) -> None:
    assert str(tmp_path) in Settings(data_dir=tmp_path).url
    assert Settings(database_url="postgresql://x/y").url == "postgresql://x/y"
