"""An import that is stopped, killed, swept beside or deceived: all comes, or nothing."""

import time
from pathlib import Path
from typing import Any

import pytest

from index.errors import CatalogueBusy, DamagedExport, StorageFull
from service.backup import importing
from service.backup.importing import import_library
from service.jobs.sweeping import sweep
from tests.backups import (
    exported,
    files_of,
    opened,
    released,
    rows_of,
)
from tests.commanding import start
from tests.serving import settings_for
from tests.storages import make_older

pytestmark = pytest.mark.usefixtures("storage")  # with files in a folder and in a bucket

LONG_AGO = 1e6  # seconds


def test_an_import_that_fails_leaves_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    archive = exported(tmp_path)
    with opened(tmp_path / "to") as library:
        rows = rows_of(library)

        def full(*_: object) -> None:
            raise StorageFull("the disk is full")

        with monkeypatch.context() as patch:
            patch.setattr(importing, "replace_library", full)
            with pytest.raises(StorageFull):
                import_library(library, archive)
        assert (rows_of(library), files_of(library)) == (rows, {})
        assert import_library(library, archive).shapes == 7


KILLED = """
import os, sys
from pathlib import Path
from service.backup import importing
from tests.backups import add_queued, describe, fail, opened
importing.replace_library = lambda *_: os._exit(9)
with opened(Path(sys.argv[2])) as library:
    importing.import_library(library, Path(sys.argv[1]))
"""


def test_an_import_that_is_killed_can_be_repeated(tmp_path: Path) -> None:
    archive = exported(tmp_path)
    settings_for(tmp_path / "to")  # notes in the folder where its files are
    with start(archive, tmp_path / "to", script=KILLED) as process:
        assert process.wait() == 9, process.communicate()
    with opened(tmp_path / "to") as library, opened(tmp_path / "from") as before:
        assert library.catalogue.list().items == ()
        assert files_of(library) == files_of(before)
        assert import_library(library, archive).shapes == 7
        assert rows_of(library) == released(rows_of(before))
        assert list((tmp_path / "to" / "incoming").rglob("*.sqlite3")) == []


def test_what_a_killed_import_left_is_swept(tmp_path: Path) -> None:
    archive = exported(tmp_path)
    settings_for(tmp_path / "to")  # notes in the folder where its files are
    with start(archive, tmp_path / "to", script=KILLED) as process:
        assert process.wait() == 9, process.communicate()
    with opened(tmp_path / "to") as library:
        assert sweep(library, older_than=-1) > 0
        assert files_of(library) == {}


def test_two_imports_into_one_library_do_not_meet(tmp_path: Path) -> None:
    archive = exported(tmp_path)
    with opened(tmp_path / "to") as library, opened(tmp_path / "to") as other:
        with importing._alone(library), pytest.raises(CatalogueBusy, match="another import"):
            import_library(other, archive)
        assert import_library(other, archive).shapes == 7


def test_files_of_a_long_import_are_kept_from_the_sweeper(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    archive = exported(tmp_path)
    put = importing._put_files
    with opened(tmp_path / "to") as library, opened(tmp_path / "from") as before:

        def put_and_sweep(*arguments: Any) -> int:
            count = put(*arguments)
            if len(arguments) == 4:  # the first round
                for key in list(library.files.keys())[:5]:
                    library.files.delete(key)
                for key in library.files.keys():  # noqa: SIM118 - no mapping
                    make_older(library.files, key, LONG_AGO)
            return count

        monkeypatch.setattr(importing, "_put_files", put_and_sweep)
        monkeypatch.setattr(importing, "_LONG", -1.0)
        import_library(library, archive)
        assert files_of(library) == files_of(before)
        assert min(moment for _, moment in library.files.changes("")) > time.time() - LONG_AGO / 2


def test_an_archive_that_changes_after_it_was_checked_is_refused(tmp_path: Path) -> None:
    archive = exported(tmp_path)
    place = archive.read_bytes().rindex(b"ply\nformat")  # far from what is read at once

    def change(what: str, _: int, __: int) -> None:
        if what == "Importing":
            with archive.open("r+b") as file:
                file.seek(place)
                file.write(b"PLY")

    with opened(tmp_path / "to") as library:
        with pytest.raises(DamagedExport, match="altered during the import"):
            import_library(library, archive, change)
        assert files_of(library) == {}
        assert library.catalogue.list().items == ()
