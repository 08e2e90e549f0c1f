from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from sqlalchemy import Engine, make_url, text

from index.database import make_engine
from index.errors import NoPgvector
from index.pgvector.extension import prepare
from tests.databases import DATABASES


@pytest.fixture
def engine(database_server: str, tmp_path: Path) -> Iterator[Engine]:
    DATABASES.kind, DATABASES.server = "postgresql", database_server
    try:
        made = make_engine(DATABASES.url(tmp_path))
    finally:
        DATABASES.kind = "sqlite"
    yield made
    made.dispose()


def test_several_processes_may_prepare_one_database(engine: Engine) -> None:
    with ThreadPoolExecutor(4) as threads:
        assert list(threads.map(prepare, [engine] * 4)) == [None] * 4
    with engine.connect() as connection:
        assert connection.scalar(text("SELECT count(*) FROM faience_index.held")) == 0


def test_sqlite_is_refused_in_words(tmp_path: Path) -> None:
    engine = make_engine(f"sqlite:///{tmp_path / 'a.db'}")
    with pytest.raises(NoPgvector, match="FAIENCE_DATABASE_URL"):
        prepare(engine)
    engine.dispose()


def test_a_user_who_may_not_add_the_extension_is_told_who_may(engine: Engine) -> None:
    with engine.begin() as connection:
        name = connection.scalar(text("SELECT current_database()"))
        connection.execute(text(f"CREATE ROLE {name} LOGIN PASSWORD 'x'"))
    url = make_url(engine.url.render_as_string(hide_password=False)).set(username=name, password="x")  # noqa: S106 - of a test's own server
    plain = make_engine(url.render_as_string(hide_password=False))
    with pytest.raises(NoPgvector, match="administrator"):
        prepare(plain)
    plain.dispose()


def test_an_old_pgvector_is_refused(engine: Engine) -> None:
    prepare(engine)
    with engine.begin() as connection:
        connection.execute(text("UPDATE pg_extension SET extversion = '0.7.4' WHERE extname = 'vector'"))
    with pytest.raises(NoPgvector, match=r"0\.7\.4 is too old"):
        prepare(engine)
