"""Webhooks are added with a secret of their own, listed without it, and removed."""

from pathlib import Path

import pytest

from index.errors import BadWebhook, WebhookNotFound
from index.webhooks import SECRET_BYTES, Webhooks
from tests.catalogues import open_catalogue

pytestmark = pytest.mark.usefixtures("database")  # on SQLite and on PostgreSQL


@pytest.fixture
def hooks(tmp_path: Path) -> Webhooks:
    return Webhooks(open_catalogue(tmp_path).engine)


def test_each_has_a_secret_of_its_own(hooks: Webhooks) -> None:
    (one, first), (other, second) = hooks.add("https://a.example/x?y=1"), hooks.add("http://127.0.0.1:3000")
    assert len(first) == len(second) == SECRET_BYTES
    assert first != second
    assert [hook.id for hook in hooks.known()] == [one.id, other.id]
    assert hooks.address(one.id) == ("https://a.example/x?y=1", first)
    hooks.remove(one.id)
    assert [hook.id for hook in hooks.known()] == [other.id]


@pytest.mark.parametrize(
    "url",
    [
        "",
        "library.example",
        "ftp://a.example",
        "https://",
        "http://[::1",
        "http://a.example:port",
        "http://a b",
        "http://a\n.example",
        "https://a.example/" + "x" * 2000,
    ],
)
def test_what_is_no_address_is_refused(hooks: Webhooks, url: str) -> None:
    with pytest.raises(BadWebhook, match="https://"):
        hooks.add(url)
    assert hooks.known() == []


def test_who_is_not_there_is_said_so(hooks: Webhooks) -> None:
    with pytest.raises(WebhookNotFound, match="webhook list"):
        hooks.remove("nobody")
    with pytest.raises(WebhookNotFound):
        hooks.address("nobody")
