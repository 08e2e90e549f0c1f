"""Settings come from the environment, and tell no keys."""

from pathlib import Path

import pytest

from service.settings import Settings, is_loopback


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
def test_loopback_is_this_machine_alone(host: str) -> None:
    assert is_loopback(host)


@pytest.mark.parametrize("host", ["0.0.0.0", "::", "192.168.1.5", "example.org", ""])  # noqa: S104
def test_anything_else_is_not_this_machine_alone(host: str) -> None:
    assert not is_loopback(host)


def test_the_catalogue_is_inside_the_data_folder_unless_a_database_is_named(tmp_path: Path) -> None:
    assert str(tmp_path) in Settings(data_dir=tmp_path).url
    assert Settings(database_url="postgresql://x/y").url == "postgresql://x/y"
