"""Nothing of an archive is believed: what no export could have written is refused, with nothing imported."""

import io
import json
import os
import tarfile
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from index.errors import ExportRefused, NewerFormat
from service.backup import checking
from service.backup.importing import import_library
from service.library import Library
from tests.backups import (
    Parts,
    exported,
    files_of,
    forged,
    opened,
    parts_of,
    rows_of,
    with_sums,
    write_parts,
)
from tests.forgeries import BLOCKS, FILES, HOSTILE, SHAPES, STATE, WORDS, appended, first_file, header


@pytest.fixture(scope="module")
def archive(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return an honest archive."""
    return exported(tmp_path_factory.mktemp("archive"))


@pytest.fixture(scope="module")
def empty(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Library]:
    """Yield a library in which every refusal leaves nothing."""
    with opened(tmp_path_factory.mktemp("empty")) as library:
        yield library


def refused(library: Library, archive: Path, code: str = "damaged_export") -> str:
    """Import what must be refused; return why it was."""
    rows = rows_of(library)
    with pytest.raises(ExportRefused) as caught:
        import_library(library, archive)
    assert rows_of(library) == rows
    assert files_of(library) == {}
    assert os.listdir(library.incoming.folder) == [".lock"]  # noqa: PTH208 - names are enough
    assert caught.value.code == code
    return str(caught.value)


@pytest.mark.parametrize("case", HOSTILE)
def test_what_no_export_could_hold_is_refused(
    empty: Library, tmp_path: Path, archive: Path, case: str
) -> None:
    change, reason = HOSTILE[case]
    parts = parts_of(archive)
    path = write_parts(tmp_path / "forged.tar", with_sums(change(parts) or parts))
    assert reason in refused(empty, path)


def test_a_newer_format_and_a_newer_schema_are_told(empty: Library, tmp_path: Path, archive: Path) -> None:
    newer = [(header(format=2, more=1), "reads up to 1"), (header(schema="9999"), "the schema '9999'")]
    for change, reason in newer:
        parts = parts_of(archive)
        change(parts)
        path = write_parts(tmp_path / "forged.tar", with_sums(parts))
        assert reason in refused(empty, path, NewerFormat.code)


def test_an_id_that_leads_outside_is_refused(empty: Library, tmp_path: Path, archive: Path) -> None:
    def change(parts: Parts) -> None:
        id_of = json.loads(parts[SHAPES].splitlines()[0])["id"]
        for name in (SHAPES, FILES, BLOCKS, WORDS, "tables/jobs.jsonl"):
            parts[name] = parts[name].replace(f'"{id_of}"'.encode(), b'"../../outside"')

    parts = parts_of(archive)
    change(parts)
    path = write_parts(tmp_path / "forged.tar", with_sums(parts))
    assert "no id of a shape" in refused(empty, path)


def test_an_altered_member_is_named(empty: Library, tmp_path: Path, archive: Path) -> None:
    parts = parts_of(archive)
    name = first_file(parts)
    parts[name] = bytes([parts[name][0] ^ 1]) + parts[name][1:]
    path = write_parts(tmp_path / "altered.tar", parts)
    assert f"the checksum of {name!r} is wrong" in refused(empty, path)


def test_a_member_that_vanished_or_came_is_named(empty: Library, tmp_path: Path, archive: Path) -> None:
    parts = parts_of(archive)
    name = first_file(parts)
    less = {each: data for each, data in parts.items() if each != name}
    assert "checksum" in refused(empty, write_parts(tmp_path / "less.tar", less))
    last = {**parts, "SHA256SUMS": b"".join(parts["SHA256SUMS"].splitlines(keepends=True)[:-1])}
    path = write_parts(tmp_path / "last.tar", last)
    assert "the checksum of 'tables/" in refused(empty, path)
    more = {**parts, "SHA256SUMS": parts["SHA256SUMS"] + b"0" * 64 + b"  files/ghost\n"}
    path = write_parts(tmp_path / "more.tar", more)
    assert "files/ghost" in refused(empty, path)


def test_a_file_that_was_cut_is_refused_wherever_it_was_cut(
    empty: Library, tmp_path: Path, archive: Path
) -> None:
    whole = archive.read_bytes()
    end = len(whole) - 1024 - 512  # the last content, then zeros
    for share in (0, 1, 511, 512, 700, len(whole) // 3, len(whole) // 2, end - 4096, end):
        path = tmp_path / "cut.tar"
        path.write_bytes(whole[:share])
        refused(empty, path)


def test_what_follows_the_end_is_refused(empty: Library, tmp_path: Path, archive: Path) -> None:
    parts = parts_of(archive)
    late = write_parts(tmp_path / "late.tar", {**parts, "tables/late.jsonl": b""})
    assert "wrong place" in refused(empty, late)
    twice = archive.read_bytes() * 2
    (tmp_path / "twice.tar").write_bytes(twice)
    assert "follows the end" in refused(empty, tmp_path / "twice.tar")


def member(name: str, kind: bytes = tarfile.REGTYPE, size: int = 0, link: str = "") -> bytes:
    info = tarfile.TarInfo(name)
    info.type, info.size, info.linkname = kind, size, link
    return info.tobuf(tarfile.GNU_FORMAT)


def beginning(whole: bytes) -> bytes:
    """Return the first member of an archive."""
    return whole[: whole.index(b"files/")]


KINDS = {
    "symbolic link": tarfile.SYMTYPE,
    "link": tarfile.LNKTYPE,
    "device": tarfile.CHRTYPE,
    "block device": tarfile.BLKTYPE,
    "pipe": tarfile.FIFOTYPE,
    "folder": tarfile.DIRTYPE,
    "long name": tarfile.GNUTYPE_LONGNAME,
    "sparse file": tarfile.GNUTYPE_SPARSE,
    "extended header": tarfile.XHDTYPE,
    "global header": tarfile.XGLTYPE,
    "unknown kind": b"Z",
}


@pytest.mark.parametrize("kind", KINDS)
def test_only_plain_files_are_taken(empty: Library, tmp_path: Path, archive: Path, kind: str) -> None:
    whole = archive.read_bytes()
    head = beginning(whole)
    odd = member("files/shapes/a/b", KINDS[kind], link="/etc/passwd")
    for data in (odd + whole, head + odd + whole[len(head) :]):
        (tmp_path / "odd.tar").write_bytes(data)
        assert "is not a plain file" in refused(empty, tmp_path / "odd.tar")


def test_the_same_member_twice_is_refused(empty: Library, tmp_path: Path, archive: Path) -> None:
    parts = parts_of(archive)
    name = first_file(parts)
    with tarfile.open(tmp_path / "twice.tar", "w") as out:
        for each in ("library.json", name, name):
            info = tarfile.TarInfo(each)
            info.size = len(parts[each])
            out.addfile(info, io.BytesIO(parts[each]))
    assert f"{name!r} twice" in refused(empty, tmp_path / "twice.tar")


def test_a_size_that_lies_is_refused(empty: Library, tmp_path: Path, archive: Path) -> None:
    whole = archive.read_bytes()
    for size in (10, 10**9, 2**60):
        head = beginning(whole)
        data = head + member("files/shapes/a/b", size=size) + whole[len(head) :]
        (tmp_path / "lie.tar").write_bytes(data)
        refused(empty, tmp_path / "lie.tar")


def test_a_line_without_end_is_refused_before_it_is_read(
    empty: Library, archive: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(checking, "LONGEST_LINE", 1 << 16)
    path = forged(archive, appended(STATE, b" " * (1 << 17)))
    assert "more than 65536 bytes" in refused(empty, path)


SHARES = st.floats(0, 1, exclude_max=True)  # of the file before the changed byte


@settings(max_examples=50, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    places=st.lists(st.tuples(st.floats(0, 1, exclude_max=True), st.integers(1, 255)), min_size=1, max_size=3)
)
def test_changed_bytes_are_refused_or_change_nothing(
    tmp_path_factory: pytest.TempPathFactory, archive: Path, places: list[tuple[float, int]]
) -> None:
    folder = tmp_path_factory.mktemp("changed")
    data = bytearray(archive.read_bytes())
    for share, change in places:
        data[int(share * len(data))] ^= change
    (folder / "changed.tar").write_bytes(data)
    with opened(folder / "to") as library:
        rows = rows_of(library)
        try:
            import_library(library, folder / "changed.tar")
        except ExportRefused:
            assert (rows_of(library), files_of(library)) == (rows, {})
        else:
            with opened(archive.parent / "honest") as honest:
                if not sum(honest.catalogue.counts().values()):
                    import_library(honest, archive)
                assert (rows_of(library), files_of(library)) == (rows_of(honest), files_of(honest))
