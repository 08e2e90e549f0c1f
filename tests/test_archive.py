"""Zips are unpacked within limits, and their tricks refused."""

import io
import stat
import struct
import zipfile

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.mesh_files import attempt
from worker.errors import Code, MeshError
from worker.reading.archive import is_hidden, list_archive, unpack
from worker.reading.limits import Limits

NAMES = st.text("abü形 .", min_size=1, max_size=5).map(lambda name: f"x{name}y")


def zipped(files: dict[str, bytes], method: int = zipfile.ZIP_DEFLATED) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", method) as archive:
        for name, data in files.items():
            archive.writestr(name, data)
    return stream.getvalue()


def refused(data: bytes, limits: Limits | None = None) -> Code:
    with pytest.raises(MeshError) as caught:
        unpack(data, limits or Limits())
    return caught.value.code


@given(st.dictionaries(NAMES, st.binary(max_size=50)))
def test_files_come_out_as_they_went_in(files: dict[str, bytes]) -> None:
    for method in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        data = zipped(files, method)
        assert unpack(data, Limits()) == files
        assert list_archive(data, Limits()) == {name: len(content) for name, content in files.items()}


def test_what_systems_add_is_left_out() -> None:
    files = {
        "a/m.obj": b"1",
        "__MACOSX/a/._m.obj": b"2",
        "a/.DS_Store": b"3",
        "a/._m.obj": b"4",
        "Thumbs.db": b"5",
        "e/": b"",
    }
    assert unpack(zipped(files), Limits()) == {"a/m.obj": b"1"}
    assert not is_hidden("a.b/m.obj")


def test_bytes_before_the_zip_do_no_harm() -> None:
    assert unpack(b"#!/bin/sh\n" + zipped({"m.obj": b"1"}), Limits()) == {"m.obj": b"1"}


@pytest.mark.parametrize(
    "name", ["../m.obj", "/m.obj", "a/../../m.obj", "a/../m.obj", "C:\\m.obj", "..\\m.obj"]
)
def test_names_that_leave_the_folder_are_refused(name: str) -> None:
    assert refused(zipped({name: b""})) == Code.UNSAFE_REFERENCE


def test_links_are_refused() -> None:
    entry = zipfile.ZipInfo("m.obj")
    entry.external_attr = (stat.S_IFLNK | 0o777) << 16
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        archive.writestr(entry, "/etc/passwd")
    assert refused(stream.getvalue()) == Code.BAD_ARCHIVE


@pytest.mark.parametrize("inner", ["b.zip", "b.tar.gz", "B.7Z"])
def test_archives_within_are_refused(inner: str) -> None:
    assert refused(zipped({"m.obj": b"", inner: b""})) == Code.BAD_ARCHIVE


def test_locked_files_are_refused() -> None:
    data = bytearray(zipped({"m.obj": b"1"}))
    for mark, place in ((b"PK\x03\x04", 6), (b"PK\x01\x02", 8)):
        data[data.index(mark) + place] |= 1
    assert refused(bytes(data)) == Code.BAD_ARCHIVE


@pytest.mark.parametrize("method", [zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA])
def test_packing_that_can_ask_for_gigabytes_is_refused(method: int) -> None:
    assert refused(zipped({"m.obj": b"1"}, method)) == Code.BAD_ARCHIVE


def test_a_name_that_comes_twice_is_refused() -> None:
    assert refused(zipped({"m.obj": b"1", "./m.obj": b"2"})) == Code.BAD_ARCHIVE


def test_limits_hold_by_what_is_announced() -> None:
    data = zipped({"a": b"0" * 600, "b": b"0" * 600})
    assert refused(data, Limits(unpacked_bytes=1_199)) == Code.ARCHIVE_TOO_LARGE
    assert refused(data, Limits(archive_entries=1)) == Code.ARCHIVE_TOO_LARGE
    assert len(unpack(data, Limits(unpacked_bytes=1_200, archive_entries=2))) == 2


@pytest.mark.parametrize("lie", [10, 2_000_000_000])
def test_a_file_that_lies_about_its_size_is_refused(lie: int) -> None:
    data = bytearray(zipped({"m.obj": b"0" * 100_000}))
    place = data.index(b"PK\x01\x02") + 24
    data[place : place + 4] = struct.pack("<I", lie)
    assert refused(bytes(data), Limits(unpacked_bytes=50_000)) in {Code.BAD_ARCHIVE, Code.ARCHIVE_TOO_LARGE}


@given(st.data())
def test_a_damaged_zip_is_read_or_refused(data: st.DataObject) -> None:
    whole = bytearray(zipped({"m.obj": b"v 0 0 0\n" * 9, "t.png": b"12"}))
    for _ in range(data.draw(st.integers(1, 3))):
        whole[data.draw(st.integers(0, len(whole) - 1))] = data.draw(st.integers(0, 255))
    cut = bytes(whole[: data.draw(st.integers(0, len(whole)))])
    damage = {None, Code.BAD_ARCHIVE, Code.ARCHIVE_TOO_LARGE, Code.UNSAFE_REFERENCE}
    assert attempt(lambda: unpack(cut, Limits())) in damage
    assert attempt(lambda: list_archive(cut, Limits())) in damage
