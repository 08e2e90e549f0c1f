"""What every place for files promises, a folder and a bucket alike."""

import hashlib
import io
import os
import time
from pathlib import Path

import pytest

from index.errors import FileMissing
from index.file_places import open_files
from index.files import FileStore
from tests.storages import PLACES

pytestmark = pytest.mark.usefixtures("storage")  # with files in a folder and in a bucket

LONG = (17 << 20) + 1  # bytes; sent to a bucket in three pieces


@pytest.fixture
def files(tmp_path: Path) -> FileStore:
    return open_files(PLACES.url(tmp_path), tmp_path / "files")


class Broken(io.BytesIO):
    """A stream that breaks off after a while."""

    def read(self, size: int | None = -1, /) -> bytes:
        """Read, up to where it breaks."""
        if self.tell() >= 9 << 20:
            raise ConnectionError("cut")
        return super().read(size)


def test_what_was_put_is_given_back(files: FileStore) -> None:
    files.put("shapes/a/files/0", b"one")
    files.put("shapes/a/files/0", b"another")
    assert files.get("shapes/a/files/0") == b"another"


@pytest.mark.parametrize("size", [0, 1, (8 << 20) - 1, 8 << 20, LONG])
def test_a_stream_is_kept_with_its_size_and_checksum(files: FileStore, size: int) -> None:
    data = os.urandom(size)
    assert files.put_stream("k", io.BytesIO(data)) == (size, hashlib.sha256(data).hexdigest())
    assert files.get("k") == data
    assert b"".join(files.pieces("k")) == data
    assert files.facts("k").size == size


def test_a_long_file_comes_in_pieces(files: FileStore) -> None:
    files.put_stream("k", io.BytesIO(bytes(LONG)))
    assert max(map(len, files.pieces("k"))) <= 8 << 20


def test_a_part_of_a_file_is_read_alone(files: FileStore) -> None:
    files.put("k", bytes(range(100)))
    assert files.get_part("k", 3, 7) == bytes([3, 4, 5, 6])
    assert files.get_part("k", 99, 100) == bytes([99])


def test_one_can_seek_in_an_open_file(files: FileStore) -> None:
    files.put("k", b"0123456789")
    with files.open("k") as file:
        file.seek(-3, os.SEEK_END)
        assert file.read(2) == b"78"


def test_a_stream_that_breaks_off_leaves_nothing_and_what_was_there(files: FileStore) -> None:
    with pytest.raises(ConnectionError):
        files.put_stream("a/b", Broken(bytes(LONG)))
    assert list(files.keys()) == []
    files.put("a/b", b"old")
    with pytest.raises(ConnectionError):
        files.put_stream("a/b", Broken(bytes(LONG)))
    assert files.get("a/b") == b"old"


@pytest.mark.parametrize(
    "key", ["", "/etc/passwd", "..", "a/../b", "a/..", "./a", "a//b", "a/", ".incoming/x", "a\\b", "ä", "a\n"]
)
def test_a_key_that_we_cannot_have_made_is_refused(files: FileStore, key: str) -> None:
    for use in (files.get, files.facts, files.open, files.delete, files.delete_all, files.changed):
        with pytest.raises(ValueError, match="not a file key"):
            use(key)
    with pytest.raises(ValueError, match="not a file key"):
        files.put(key, b"")
    with pytest.raises(ValueError, match="not a file key"):
        files.put_stream(key, io.BytesIO())


def test_what_is_absent_is_named(files: FileStore) -> None:
    files.put("a/c", b"")
    for use in (files.get, files.facts, files.open, lambda key: list(files.pieces(key))):
        with pytest.raises(FileMissing, match="'a/b'"):
            use("a/b")
    with pytest.raises(FileMissing, match="'a/b'"):
        files.get_part("a/b", 0, 1)


def test_deleting_what_is_absent_is_fine_and_takes_nothing_else(files: FileStore) -> None:
    for key in ("shapes/a/files/0", "shapes/a/thumbnail.png", "shapes/ab/0", "shapes/b/0"):
        files.put(key, b"")
    for _ in range(2):
        files.delete("shapes/a/files/0")
    assert list(files.keys()) == ["shapes/a/thumbnail.png", "shapes/ab/0", "shapes/b/0"]
    for _ in range(2):
        files.delete_all("shapes/a")
    assert list(files.keys()) == ["shapes/ab/0", "shapes/b/0"]


def test_keys_of_a_folder_are_listed_in_order(files: FileStore) -> None:
    for key in ("b/2", "a/1/x", "a/10", "a/2"):
        files.put(key, b"")
    assert list(files.keys()) == ["a/1/x", "a/10", "a/2", "b/2"]
    assert list(files.keys("a")) == ["a/1/x", "a/10", "a/2"]
    assert list(files.keys("c")) == []


def test_each_file_tells_when_it_was_written(files: FileStore) -> None:
    before = int(time.time())
    files.put("a/1", b"")
    assert dict(files.changes("a")).keys() == {"a/1"}
    assert before <= dict(files.changes("a"))["a/1"] <= time.time() + 1
    assert files.changed("a/1") == pytest.approx(dict(files.changes("a"))["a/1"], abs=1)
    assert files.changed("a/absent") >= before


def test_another_content_has_another_tag(files: FileStore) -> None:
    tags = []
    for data in (b"one", b"four", b"nine!"):
        files.put("k", data)
        tags.append(files.facts("k").tag)
    assert len(set(tags)) == 3
    assert files.facts("k").tag == tags[-1]


def test_what_was_put_unflushed_is_there(files: FileStore) -> None:
    files.put("a/1", b"one", flushed=False)
    files.put_stream("a/2", io.BytesIO(b"two"), flushed=False)
    files.flush(["a/1", "a/2"])
    assert [files.get(key) for key in files.keys("a")] == [b"one", b"two"]
    assert files.sweep(0) == 0
