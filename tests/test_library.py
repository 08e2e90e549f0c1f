"""A library is made on first opening and found on the next."""

from pathlib import Path
from types import SimpleNamespace

import pytest

from index.catalogue import Catalogue
from index.database import make_engine
from index.errors import NoPgvector, StorageFull, UnknownStorage
from index.migrating import migrate
from index.vocabulary import default_vocabulary
from service.library import Library
from tests.databases import DATABASES
from tests.serving import fake_vocabulary, settings_for
from tests.storages import PLACES


def test_a_library_whose_first_vocabulary_another_process_is_adding_opens(tmp_path: Path) -> None:
    settings = settings_for(tmp_path)
    engine = make_engine(settings.url)
    migrate(engine)
    Catalogue(engine).add_vocabulary(fake_vocabulary())  # and is killed, or not so far yet
    engine.dispose()
    library = Library.open(settings, vocabulary=fake_vocabulary())
    assert library.catalogue.state().vocabulary_id == fake_vocabulary().id
    library.close()


def test_a_new_library_starts_with_the_vocabulary_that_ships(tmp_path: Path) -> None:
    library = Library.open(settings_for(tmp_path / "made" / "here"))
    active = library.catalogue.active_vocabulary()
    library.close()
    assert active is not None
    assert active.id == default_vocabulary().id


def test_opening_again_keeps_the_vocabulary(tmp_path: Path) -> None:
    Library.open(settings_for(tmp_path), vocabulary=fake_vocabulary()).close()
    library = Library.open(settings_for(tmp_path))
    active = library.catalogue.active_vocabulary()
    library.close()
    assert active is not None
    assert active.id == fake_vocabulary().id


def test_closing_leaves_no_temporary_files(tmp_path: Path) -> None:
    library = Library.open(settings_for(tmp_path), vocabulary=fake_vocabulary())
    assert library.incoming.folder.is_dir()
    library.close()
    assert not library.incoming.folder.exists()


def test_a_reserve_of_the_disk_is_kept(tmp_path: Path) -> None:
    library = Library.open(settings_for(tmp_path, reserve_bytes=1), vocabulary=fake_vocabulary())
    library.check_space(10)
    with pytest.raises(StorageFull):
        library.check_space(2**60)
    library.close()


@pytest.mark.parametrize(("kind", "factor"), [("local", 2), ("s3", 1)])
def test_an_upload_is_written_twice_where_files_are_kept_and_once_where_they_are_not(
    kind: str, factor: int, tmp_path: Path, object_server: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(PLACES, "kind", kind)
    library = Library.open(settings_for(tmp_path, reserve_bytes=0), vocabulary=fake_vocabulary())
    monkeypatch.setattr("service.library.shutil.disk_usage", lambda _: SimpleNamespace(free=1000 * factor))
    library.check_space(1000)
    with pytest.raises(StorageFull):
        library.check_space(1001)
    library.close()


def test_a_wrong_address_of_the_files_is_refused_at_the_start(tmp_path: Path) -> None:
    with pytest.raises(UnknownStorage, match="not in 'ftp'"):
        Library.open(settings_for(tmp_path, storage_url="ftp://host/files"))
    assert list(tmp_path.iterdir()) == []


def test_vectors_in_pgvector_need_a_catalogue_in_postgresql(tmp_path: Path) -> None:
    with pytest.raises(NoPgvector, match="FAIENCE_DATABASE_URL"):
        Library.open(settings_for(tmp_path, index="pgvector"), vocabulary=fake_vocabulary())


@pytest.mark.parametrize(("kind", "proven"), [("memory", True), ("pgvector", True), ("pgvector-hnsw", False)])
def test_the_settings_say_where_vectors_are(
    database_server: str, tmp_path: Path, kind: str, proven: bool
) -> None:
    DATABASES.kind, DATABASES.server = "postgresql", database_server
    try:
        library = Library.open(settings_for(tmp_path, index=kind), vocabulary=fake_vocabulary())
    finally:
        DATABASES.kind = "sqlite"
    assert library.searcher.proves("fused", 24) == proven
    assert library.searcher.escalations() == {"fused": 0}
    library.close()
