"""An export is a tar for anyone's tools, of one moment, complete or not there at all."""

import errno
import json
import os
import shutil
import subprocess
import sys
import tarfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from sqlalchemy import text, update

from index.database import writing
from index.errors import DamagedExport, StorageFull
from index.tables import PlainBlockRow
from service.backup.belongings import present_files
from service.backup.exporting import export_library
from service.backup.importing import import_library
from service.retrieval import change_shape, remove_shape
from tests.backups import (
    add_queued,
    add_ready,
    exported,
    fail,
    files_of,
    fill,
    opened,
    parts_of,
    rows_of,
)
from tests.made_migrations import DECISIONS, pretend_newer
from tests.storages import on_disk, only_folders

pytestmark = pytest.mark.usefixtures("kept")  # on SQLite and on PostgreSQL, and with files in a bucket


def lines(data: bytes) -> list[dict[str, Any]]:
    return [json.loads(line) for line in data.splitlines()]


def test_the_members_come_in_their_order(tmp_path: Path) -> None:
    names = list(parts_of(exported(tmp_path)))
    assert names[0] == "library.json"
    assert names[-1] == "SHA256SUMS"
    tables = [name for name in names if name.startswith("tables/")]
    assert names[-1 - len(tables) : -1] == tables
    assert all(name.startswith("files/") for name in names[1 : -1 - len(tables)])
    with opened(tmp_path / "from") as library:
        assert {f"tables/{name}.jsonl" for name in rows_of(library)} == set(tables)
        assert {f"files/{key}" for key in files_of(library)} == {n for n in names if n.startswith("files/")}


@pytest.mark.skipif(
    not (shutil.which("tar") and shutil.which("sha256sum")), reason="ordinary tools are missing"
)
def test_ordinary_tools_unpack_it_and_check_it(tmp_path: Path) -> None:
    archive, folder = exported(tmp_path), tmp_path / "unpacked"
    folder.mkdir()
    told = [
        subprocess.run(command, cwd=folder, capture_output=True, text=True, check=True)
        for command in (["tar", "xf", str(archive)], ["sha256sum", "--strict", "-c", "SHA256SUMS"])
    ]
    assert all(result.stderr == "" for result in told)
    assert told[1].stdout.count(": OK\n") == len(parts_of(archive)) - 1


def test_it_says_what_it_is(tmp_path: Path) -> None:
    header = json.loads(parts_of(exported(tmp_path))["library.json"])
    with opened(tmp_path / "from") as library:
        assert header["fingerprint"] == library.parameters.fingerprint()
        assert header["counts"] == {name: len(rows) for name, rows in rows_of(library).items()}
    assert header["format"] == 1
    assert header.keys() == {"format", "faience", "schema", "fingerprint", "exported_at", "counts"}


def test_what_belongs_to_no_shape_stays_behind(tmp_path: Path) -> None:
    with opened(tmp_path / "from") as library:
        shape = add_ready(library, 10)
        library.files.put("uploads/killed/0", b"never got a row")
        if library.files.folder is not None:
            (library.files.folder / f"shapes/{shape.id}/.DS_Store").write_bytes(b"a file manager's")
        summary = export_library(library, tmp_path / "library.tar")
    names = [name for name in parts_of(tmp_path / "library.tar") if name.startswith("files/")]
    assert len(names) == summary.files == 4
    assert summary.damaged == ()


def test_all_rows_are_of_one_moment(tmp_path: Path) -> None:
    with opened(tmp_path / "from") as library, opened(tmp_path / "from") as other:
        shapes = [add_ready(library, red) for red in (10, 60)]
        expected = rows_of(library)

        def change(done: int, _: int) -> None:
            if done == 1:
                change_shape(other, shapes[0].id, name="later", metadata={"late": True})
                add_ready(other, 110)

        export_library(library, tmp_path / "library.tar", progress=change)
    with opened(tmp_path / "to") as library:
        import_library(library, tmp_path / "library.tar")
        assert rows_of(library) == expected


def test_a_shape_that_is_removed_meanwhile_is_left_out_whole(tmp_path: Path) -> None:
    with opened(tmp_path / "from") as library, opened(tmp_path / "from") as other:
        first, last = sorted((add_ready(library, red) for red in (10, 60)), key=lambda shape: shape.id)

        def remove(done: int, _: int) -> None:
            if done == 1:
                remove_shape(other, last.id)

        summary = export_library(library, tmp_path / "library.tar", progress=remove)
    assert (summary.shapes, summary.left_out, summary.damaged) == (1, (last.id,), ())
    assert not any(last.id.encode() in data for data in parts_of(tmp_path / "library.tar").values())
    with opened(tmp_path / "to") as library:
        imported = import_library(library, tmp_path / "library.tar")
        assert imported.files == summary.files
        assert [shape.id for shape in library.catalogue.list().items] == [first.id]


def test_half_the_files_of_a_shape_that_vanishes_are_taken_out_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with opened(tmp_path / "from") as library, opened(tmp_path / "from") as other:
        shape = add_ready(library, 10)
        pieces = library.files.pieces

        def late(key: str) -> Iterator[bytes]:
            if key.endswith("signatures.npz"):
                remove_shape(other, shape.id)
            return pieces(key)

        monkeypatch.setattr(library.files, "pieces", late)
        assert export_library(library, tmp_path / "library.tar").left_out == (shape.id,)
    assert not any(name.startswith("files/") for name in parts_of(tmp_path / "library.tar"))


def test_a_failed_shape_that_is_sent_anew_meanwhile_is_left_out(tmp_path: Path) -> None:
    with opened(tmp_path / "from") as library, opened(tmp_path / "from") as other:
        add_queued(library, 10)
        fail(library)
        shape = library.catalogue.list().items[0]

        def present(*arguments: Any) -> Any:
            found = present_files(*arguments)
            add_queued(other, 10)
            return found

        with pytest.MonkeyPatch.context() as patch:
            patch.setattr("service.backup.exporting.present_files", present)
            summary = export_library(library, tmp_path / "library.tar")
    assert (summary.shapes, summary.left_out) == (0, (shape.id,))


@only_folders
def test_what_is_missing_altered_or_unreadable_is_told_and_the_rest_is_saved(tmp_path: Path) -> None:
    with opened(tmp_path / "from") as library:
        one, two, three, four = (add_ready(library, red) for red in (10, 60, 110, 160))
        library.files.delete(one.files[0].key)
        library.files.put(two.files[0].key, b"rotten")
        path = on_disk(library.files).path(f"shapes/{three.id}/preview.glb")
        path.unlink()
        path.mkdir()  # reading it fails, for root too
        summary = export_library(library, tmp_path / "library.tar")
    assert {(damage.code, damage.shape, damage.what) for damage in summary.damaged} == {
        ("file_missing", one.id, one.files[0].key),
        ("file_altered", two.id, two.files[0].key),
        ("file_unreadable", three.id, f"shapes/{three.id}/preview.glb"),
    }
    parts = parts_of(tmp_path / "library.tar")
    assert summary.files == len([name for name in parts if name.startswith("files/")]) == 4 * 4 - 2
    assert parts[f"files/{two.files[0].key}"] == b"rotten"
    assert {row["id"] for row in lines(parts["tables/shapes.jsonl"])} == {one.id, two.id, three.id, four.id}


def test_rows_that_no_import_would_take_are_told(tmp_path: Path) -> None:
    with opened(tmp_path / "from") as library:
        shape = add_ready(library, 10)
        with writing(library.engine) as session:
            session.execute(update(PlainBlockRow).values(data=b"rotten"))
        (damage,) = export_library(library, tmp_path / "library.tar").damaged
    assert damage.code == "rows_damaged"
    assert shape.id in damage.what
    with opened(tmp_path / "to") as library, pytest.raises(DamagedExport, match=shape.id):
        import_library(library, tmp_path / "library.tar")


def test_tables_of_later_versions_come_along(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pretend_newer(monkeypatch, tmp_path, DECISIONS)
    with opened(tmp_path / "from") as library, opened(tmp_path / "from") as other:
        kept, gone = sorted((add_ready(library, red) for red in (10, 60)), key=lambda shape: shape.id)
        with writing(library.engine) as session:
            for number, shape in enumerate((kept, gone)):
                values = {"n": number, "s": shape.id}
                session.execute(
                    text("INSERT INTO decisions VALUES (:n, :s, '{\"same\": true}', 0.1)"), values
                )
                session.execute(text("INSERT INTO agreements VALUES (:n, 'somebody')"), values)
            session.execute(text("INSERT INTO decisions VALUES (7, :s, NULL, 1e-300)"), {"s": kept.id})
        expected = rows_of(library)

        def remove(done: int, _: int) -> None:
            if done == 1:
                remove_shape(other, gone.id)

        export_library(library, tmp_path / "library.tar", progress=remove)
    with opened(tmp_path / "to") as library:
        import_library(library, tmp_path / "library.tar")
        rows = rows_of(library)
        with library.engine.connect() as connection:
            count = connection.execute(text("SELECT count(*) FROM decisions WHERE verdict IS NULL"))
            assert count.scalar_one() == 1  # not the word null
    assert rows["decisions"] == [row for row in expected["decisions"] if row["shape_id"] == kept.id]
    assert [row["decision_id"] for row in rows["agreements"]] == [0]


def test_an_existing_file_is_kept_unless_it_may_be_replaced(tmp_path: Path) -> None:
    with opened(tmp_path / "from") as library:
        fill(library)
        (tmp_path / "library.tar").write_bytes(b"older")
        with pytest.raises(FileExistsError):
            export_library(library, tmp_path / "library.tar")
        assert (tmp_path / "library.tar").read_bytes() == b"older"
        export_library(library, tmp_path / "library.tar", replace=True)
    assert tarfile.is_tarfile(tmp_path / "library.tar")


def test_a_full_disk_leaves_nothing_and_keeps_the_older_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(_: int) -> None:
        raise OSError(errno.ENOSPC, "no space")

    with opened(tmp_path / "from") as library:
        fill(library)
        (tmp_path / "out").mkdir()
        (tmp_path / "out" / "library.tar").write_bytes(b"older")
        monkeypatch.setattr("service.backup.writing.os.fsync", full)
        with pytest.raises(StorageFull):
            export_library(library, tmp_path / "out" / "library.tar", replace=True)
        monkeypatch.undo()
    assert os.listdir(tmp_path / "out") == ["library.tar"]  # noqa: PTH208 - names are enough
    assert (tmp_path / "out" / "library.tar").read_bytes() == b"older"


LIMITED = """
import resource, signal, sys
from pathlib import Path
from index.errors import StorageFull
from service.backup.belongings import present_files
from service.backup.exporting import export_library
from tests.backups import opened
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
with opened(Path(sys.argv[1])) as library:
    resource.setrlimit(resource.RLIMIT_FSIZE, (40_000, 40_000))
    try:
        export_library(library, Path(sys.argv[2]))
    except OSError as error:
        print(error.strerror)
"""


@only_folders
def test_a_disk_that_fills_on_the_way_leaves_nothing(tmp_path: Path) -> None:
    exported(tmp_path)
    (tmp_path / "out").mkdir()
    arguments = [tmp_path / "from", tmp_path / "out" / "library.tar"]
    command = [sys.executable, "-c", LIMITED, *map(str, arguments)]
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parent.parent)}
    told = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert told.stdout == "File too large\n", told.stderr
    assert os.listdir(tmp_path / "out") == []  # noqa: PTH208 - names are enough


def test_an_export_that_is_stopped_leaves_nothing(tmp_path: Path) -> None:
    def stop(*_: int) -> None:
        raise KeyboardInterrupt

    with opened(tmp_path / "from") as library:
        fill(library)
        (tmp_path / "out").mkdir()
        with pytest.raises(KeyboardInterrupt):
            export_library(library, tmp_path / "out" / "library.tar", progress=stop)
    assert os.listdir(tmp_path / "out") == []  # noqa: PTH208 - names are enough
