import errno
import io
import os
import stat
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from types import SimpleNamespace

import pytest

from index.errors import StorageFull
from index.local_files import LocalFiles


def everything_in(root: Path) -> list[str]:
    return sorted(str(path.relative_to(root)) for path in root.rglob("*") if path.name != ".incoming")


def test_the_content_is_flushed_before_the_name_appears_and_the_folder_after(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    store = LocalFiles(tmp_path)
    store.put("shapes/first", b"makes the folders")
    steps: list[tuple[str, str]] = []
    flush, replace = os.fsync, os.replace

    def watched_flush(descriptor: int) -> None:
        status = os.fstat(descriptor)
        steps.append(("flush", "folder" if stat.S_ISDIR(status.st_mode) else f"{status.st_size} bytes"))
        flush(descriptor)

    def watched_replace(source: str | Path, target: str | Path) -> None:
        steps.append(("rename", Path(target).name))
        replace(source, target)

    monkeypatch.setattr(os, "fsync", watched_flush)
    monkeypatch.setattr(os, "replace", watched_replace)
    store.put("shapes/second", b"12345")
    assert steps == [("flush", "5 bytes"), ("rename", "second"), ("flush", "folder")]


def test_new_folders_are_made_durable_too(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    flushed: list[Path] = []
    flush = os.fsync

    def watched_flush(descriptor: int) -> None:
        flushed.append(Path(f"/proc/self/fd/{descriptor}").resolve())
        flush(descriptor)

    monkeypatch.setattr(os, "fsync", watched_flush)
    LocalFiles(tmp_path).put("a/b/c", b"")
    assert {tmp_path, tmp_path / "a", tmp_path / "a" / "b"} <= set(flushed)


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EDQUOT])
def test_a_full_disk_is_named_and_leaves_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, number: int
) -> None:
    store = LocalFiles(tmp_path)

    def full(_descriptor: int) -> None:
        raise OSError(number, os.strerror(number))

    with monkeypatch.context() as patch:
        patch.setattr(os, "fsync", full)
        with pytest.raises(StorageFull):
            store.put("shapes/a/files/0", b"data")
    assert everything_in(tmp_path) == []
    store.put("shapes/a/files/0", b"data")
    assert store.get("shapes/a/files/0") == b"data"


def test_a_disk_that_fills_while_a_file_is_replaced_keeps_the_old_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    store = LocalFiles(tmp_path)
    store.put("a/b", b"old")

    def full(_source: object, _target: object) -> None:
        raise OSError(errno.ENOSPC, "no space")

    monkeypatch.setattr(os, "replace", full)
    with pytest.raises(StorageFull):
        store.put("a/b", b"new")
    assert store.get("a/b") == b"old"
    assert everything_in(tmp_path) == ["a", "a/b"]


def test_a_stream_that_breaks_off_leaves_nothing(tmp_path: Path) -> None:
    class Broken(io.BytesIO):
        def read(self, size: int | None = -1, /) -> bytes:
            if self.tell():
                raise ConnectionError("cut")
            return super().read(size)

    with pytest.raises(ConnectionError):
        LocalFiles(tmp_path).put_stream("a/b", Broken(b"x" * (2 << 20)))
    assert everything_in(tmp_path) == []


def test_deleting_removes_emptied_folders_and_only_those(tmp_path: Path) -> None:
    store = LocalFiles(tmp_path)
    for key in ("shapes/a/files/0", "shapes/a/thumbnail.png", "shapes/b/files/0"):
        store.put(key, b"")
    store.delete("shapes/a/files/0")
    store.delete("shapes/a/files/0")
    assert list(store.keys()) == ["shapes/a/thumbnail.png", "shapes/b/files/0"]
    store.delete_all("shapes/a")
    store.delete_all("shapes/a")
    assert everything_in(tmp_path) == ["shapes", "shapes/b", "shapes/b/files", "shapes/b/files/0"]


def test_keys_of_a_folder_are_listed_without_half_written_files(tmp_path: Path) -> None:
    store = LocalFiles(tmp_path)
    store.put("a/1", b"")
    store.put("b/2", b"")
    (tmp_path / ".incoming" / "half").write_bytes(b"")
    assert list(store.keys()) == ["a/1", "b/2"]
    assert list(store.keys("b")) == ["b/2"]
    assert list(store.keys("c")) == []


def test_sweeping_removes_old_half_written_files_alone(tmp_path: Path) -> None:
    store = LocalFiles(tmp_path)
    store.put("a/1", b"")
    for name, modified in (("old", 1_000.0), ("future", 9e9)):
        path = tmp_path / ".incoming" / name
        path.write_bytes(b"")
        os.utime(path, (modified, modified))
    assert store.sweep(60) == 1
    assert sorted(path.name for path in (tmp_path / ".incoming").iterdir()) == ["future"]
    assert list(store.keys()) == ["a/1"]


def test_deleting_beside_writing_in_one_folder_harms_neither(tmp_path: Path) -> None:
    store = LocalFiles(tmp_path)

    def again_and_again(name: str) -> None:
        for _ in range(60):
            store.put(f"shared/{name}", b"x")
            assert store.get(f"shared/{name}") == b"x"
            store.delete(f"shared/{name}")

    with ThreadPoolExecutor(4) as threads:
        for done in [threads.submit(again_and_again, f"n{number}") for number in range(4)]:
            done.result()
    assert everything_in(tmp_path) == []


def test_many_files_are_flushed_at_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    flushed: list[int] = []  # inodes, and 0 for everything
    monkeypatch.setattr("index.local_files.os.sync", lambda: flushed.append(0))
    monkeypatch.setattr("index.local_files.os.fsync", lambda number: flushed.append(os.fstat(number).st_ino))
    store = LocalFiles(tmp_path / "files")
    keys = ["a/b/0", "a/b/1", "a/c/0"]
    for key in keys:
        store.write(key, lambda file: file.write(b"x"), flushed=False)
    assert flushed == []
    monkeypatch.setattr("index.local_files.sys", SimpleNamespace(platform="linux"))
    store.flush(keys)
    assert flushed == [0]
    monkeypatch.setattr("index.local_files.sys", SimpleNamespace(platform="darwin"))
    store.flush(keys)
    needed = [tmp_path, *(tmp_path / "files" / place for place in ("", "a", "a/b", "a/c", *keys))]
    assert set(flushed[1:]) == {path.stat().st_ino for path in needed}
