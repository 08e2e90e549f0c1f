"""An archive that is being written can be taken back to where it was."""

import errno
import io
import tarfile
from collections.abc import Iterator
from hashlib import sha256
from pathlib import Path

import pytest

from service.backup.writing import ArchiveWriter, writing_archive


def _failing(error: BaseException) -> Iterator[bytes]:
    yield b"half"
    raise error


def _read(data: bytes) -> dict[str, bytes]:
    with tarfile.open(fileobj=io.BytesIO(data)) as archive:
        streams = {info.name: archive.extractfile(info) for info in archive}
        return {name: stream.read() for name, stream in streams.items() if stream is not None}


def test_checksums_follow_the_members_in_their_order() -> None:
    file = io.BytesIO()
    writer = ArchiveWriter(file, io.BytesIO(), 0)
    written = [writer.add("b", [b"12", b"3"]), writer.add("a", [])]
    assert writer.finish() == len(file.getvalue())
    assert [each.size for each in written] == [3, 0]
    sums = f"{sha256(b'123').hexdigest()}  b\n{sha256(b'').hexdigest()}  a\n".encode()
    assert _read(file.getvalue()) == {"b": b"123", "a": b"", "SHA256SUMS": sums}


def test_a_member_that_fails_leaves_nothing() -> None:
    file, sums = io.BytesIO(), io.BytesIO()
    writer = ArchiveWriter(file, sums, 0)
    writer.add("first", [b"1"])
    before = (file.getvalue(), sums.getvalue())
    with pytest.raises(OSError, match="bad sector"):
        writer.add("second", _failing(OSError(errno.EIO, "bad sector")))
    assert (file.getvalue(), sums.getvalue()) == before
    writer.add("third", [b"3"])
    writer.finish()
    assert list(_read(file.getvalue())) == ["first", "third", "SHA256SUMS"]


def test_members_are_taken_back_to_a_mark() -> None:
    file = io.BytesIO()
    writer = ArchiveWriter(file, io.BytesIO(), 0)
    writer.add("kept", [b"1"])
    mark = writer.mark()
    for name in ("x", "y"):
        writer.add(name, [b"gone"])
    writer.rewind(mark)
    writer.finish()
    assert list(_read(file.getvalue())) == ["kept", "SHA256SUMS"]


def test_a_file_that_comes_meanwhile_is_not_replaced(tmp_path: Path) -> None:
    path = tmp_path / "a.tar"

    def write() -> None:
        with writing_archive(path, replace=False, moment=0) as archive:
            archive.add("a", [b"1"])
            path.write_bytes(b"somebody's")

    with pytest.raises(FileExistsError):
        write()
    assert path.read_bytes() == b"somebody's"
    assert list(tmp_path.iterdir()) == [path]


def test_a_folder_is_never_replaced(tmp_path: Path) -> None:
    with pytest.raises(FileExistsError), writing_archive(tmp_path, replace=True, moment=0):
        pass
