"""Keys are made once, listed without their secrets, and open nothing after they are revoked."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from sqlalchemy import Engine, create_engine, make_url, text

from index.database import make_engine
from index.errors import BadKeyName, KeyNotFound
from index.key_secrets import digest_of
from index.keys import NAME_LENGTH, Keys, has_active_key
from index.migrating import migrate
from index.revisions import now
from index.scopes import Scope
from tests.databases import DATABASES, only_on_sqlite

DRIVERS = {"sqlite": "sqlite", "postgresql": "postgresql+psycopg"}

pytestmark = pytest.mark.usefixtures("database")  # on SQLite and on PostgreSQL


def url_in(folder: Path) -> str:
    return DATABASES.url(folder)


@pytest.fixture
def engine(tmp_path: Path) -> Iterator[Engine]:
    made = make_engine(url_in(tmp_path))
    migrate(made)
    yield made
    made.dispose()


@pytest.mark.parametrize("scope", Scope)
def test_a_new_key_is_listed_and_active(engine: Engine, scope: Scope) -> None:
    before = now()
    key, secret = Keys(engine).create(" loan desk ", scope)
    assert (key.name, key.scope, key.revoked_at) == ("loan desk", scope, None)
    assert before <= key.created_at <= now()
    assert Keys(engine).known() == [key]
    (active,) = Keys(engine).active()
    assert (active.id, active.scope, active.digest) == (key.id, scope, digest_of(secret.encode()))


@only_on_sqlite
def test_the_secret_is_nowhere_in_the_files_of_the_database(engine: Engine, tmp_path: Path) -> None:
    key, secret = Keys(engine).create("loan desk", Scope.WRITE)
    written = b"".join(path.read_bytes() for path in tmp_path.iterdir())
    assert key.id.encode() in written
    assert digest_of(secret.encode()) in written
    assert secret.split("_", 2)[2].encode() not in written


def test_neither_the_secret_nor_its_digest_shows_when_keys_are_printed(engine: Engine) -> None:
    keys = Keys(engine)
    _, secret = keys.create("loan desk", Scope.WRITE)
    shown = f"{keys.known()} {keys.active()}"
    assert secret not in shown
    assert repr(digest_of(secret.encode())) not in shown


def test_a_revoked_key_stays_in_the_list_and_opens_nothing(engine: Engine) -> None:
    keys = Keys(engine)
    first, _ = keys.create("first", Scope.READ)
    second, _ = keys.create("second", Scope.READ)
    revoked = keys.revoke(first.id)
    assert revoked.revoked_at is not None
    assert keys.known() == [revoked, second]
    assert [key.id for key in keys.active()] == [second.id]
    assert keys.revoke(first.id) == revoked  # again: the first moment stays


def test_an_unknown_id_is_said_to_be_unknown(engine: Engine) -> None:
    with pytest.raises(KeyNotFound, match="faience key list"):
        Keys(engine).revoke("0123456789")


@pytest.mark.parametrize("name", ["", "  ", "x" * (NAME_LENGTH + 1), "a\nb", "a\x00b"])
def test_a_name_that_no_list_could_show_is_refused(engine: Engine, name: str) -> None:
    with pytest.raises(BadKeyName, match="printable"):
        Keys(engine).create(name, Scope.READ)
    assert Keys(engine).known() == []


def test_whether_a_library_has_an_active_key_is_told_from_outside(engine: Engine, tmp_path: Path) -> None:
    assert not has_active_key(url_in(tmp_path))
    key, _ = Keys(engine).create("only", Scope.READ)
    assert has_active_key(url_in(tmp_path))
    Keys(engine).revoke(key.id)
    assert not has_active_key(url_in(tmp_path))


@only_on_sqlite
def test_asking_a_library_that_is_not_there_makes_nothing(tmp_path: Path) -> None:
    assert not has_active_key(url_in(tmp_path / "nowhere"))
    assert not has_active_key(url_in(tmp_path))
    assert list(tmp_path.iterdir()) == []


def test_a_library_of_a_version_before_keys_has_none(tmp_path: Path) -> None:
    plain = create_engine(make_url(url_in(tmp_path)).set(drivername=DRIVERS[DATABASES.kind]))
    with plain.begin() as connection:
        connection.execute(text("CREATE TABLE shapes (id TEXT)"))
    plain.dispose()
    assert not has_active_key(url_in(tmp_path))
