"""What only a bucket shows: refusals, servers that fail, what is signed and what browsers are told."""

import base64
import hashlib
import io
import os
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest

from index import object_client
from index.errors import FileMissing, StorageUnreachable
from index.object_files import ObjectFiles
from tests.faulty_storage import Door, Fault, door
from tests.storages import BUCKET

LONG = 17 << 20  # bytes; three pieces


@pytest.fixture
def server(object_server: str, monkeypatch: pytest.MonkeyPatch) -> Iterator[Door]:
    monkeypatch.setattr(object_client, "RETRIES", 1)
    with door(object_server) as opened:
        yield opened


@pytest.fixture
def files(server: Door, tmp_path: Path) -> ObjectFiles:
    place = hashlib.sha256(str(tmp_path).encode()).hexdigest()[:16]
    return ObjectFiles(f"s3://{BUCKET}/{place}/files", server.address)


def parts_of(server: Door) -> list[str]:
    return [path for method, path in server.asked if method == "PUT" and "partNumber" in path]


def left_of_uploads(server: Door) -> str:
    return httpx.get(f"{server.address}/{BUCKET}?uploads").text


def test_a_long_file_is_sent_in_parts_and_a_short_one_at_once(files: ObjectFiles, server: Door) -> None:
    files.put_stream("short", io.BytesIO(b"x"))
    assert [method for method, _ in server.asked] == ["PUT"]
    assert parts_of(server) == []
    files.put_stream("long", io.BytesIO(bytes(LONG)))
    assert len(parts_of(server)) == 3


def test_the_server_is_told_the_checksum_of_what_it_gets(files: ObjectFiles, server: Door) -> None:
    files.put_stream("k", io.BytesIO(b"content"))
    digest = hashlib.sha256(b"content")
    assert base64.b64decode(server.told["x-amz-checksum-sha256"]) == digest.digest()
    assert server.told["x-amz-content-sha256"] == digest.hexdigest()
    assert "x-amz-content-sha256" in server.told["authorization"]


@pytest.mark.parametrize(
    ("key", "kind"),
    [
        ("shapes/a/preview.glb", "model/gltf-binary"),
        ("shapes/a/thumbnail.png", "image/png"),
        ("uploads/a/0", "application/octet-stream"),
    ],
)
def test_who_follows_a_signed_address_is_told_to_save_the_file(
    files: ObjectFiles, key: str, kind: str
) -> None:
    files.put(key, b"<script>alert(1)</script>")
    files.put_stream(key, io.BytesIO(b"<script>alert(2)</script>"))
    answer = httpx.get(str(files.address(key, 60)))
    assert (answer.content, answer.headers["content-type"]) == (b"<script>alert(2)</script>", kind)
    assert answer.headers["content-disposition"] == "attachment"


@pytest.mark.parametrize("status", [500, 503, 0])
def test_a_server_that_fails_is_named_whatever_was_asked(
    files: ObjectFiles, server: Door, status: int
) -> None:
    files.put("k", b"kept")
    server.fault = lambda _method, _path: status
    for ask in (
        lambda: files.put("k", b"x"),
        lambda: files.put_stream("k", io.BytesIO(bytes(LONG))),
        lambda: files.get("k"),
        lambda: files.get_part("k", 0, 1),
        lambda: list(files.pieces("k")),
        lambda: files.facts("k"),
        lambda: list(files.keys()),
        lambda: files.delete("k"),
        lambda: files.delete_all("a"),
        files.check,
    ):
        with pytest.raises(StorageUnreachable):
            ask()
    server.open()
    assert files.get("k") == b"kept"


def test_a_request_that_failed_once_is_repeated(files: ObjectFiles, server: Door) -> None:
    answers = [500]
    server.fault = lambda _method, _path: answers.pop() if answers else None
    files.put("k", b"kept")
    assert files.get("k") == b"kept"
    assert [method for method, _ in server.asked] == ["PUT", "PUT", "GET"]


@pytest.mark.parametrize("status", [401, 403])
def test_credentials_that_are_refused_are_named(files: ObjectFiles, server: Door, status: int) -> None:
    server.fault = lambda _method, _path: status
    with pytest.raises(StorageUnreachable):
        files.get("k")
    with pytest.raises(StorageUnreachable):
        files.check()


def second_part(method: str, path: str) -> int | None:
    return 500 if method == "PUT" and "partNumber=2" in path else None


def second_part_cut(method: str, path: str) -> int | None:
    return 0 if method == "PUT" and "partNumber=2" in path else None


def end_of_upload(method: str, path: str) -> int | None:
    return 500 if method == "POST" and "uploadId" in path else None


@pytest.mark.parametrize("fault", [second_part, second_part_cut, end_of_upload])
def test_an_upload_that_fails_in_the_middle_leaves_nothing_and_can_be_repeated(
    files: ObjectFiles, server: Door, fault: Fault
) -> None:
    data = os.urandom(LONG)
    server.fault = fault
    with pytest.raises(StorageUnreachable):
        files.put_stream("k", io.BytesIO(data))
    server.open()
    with pytest.raises(FileMissing):
        files.get("k")
    assert "<UploadId>" not in left_of_uploads(server)
    assert files.put_stream("k", io.BytesIO(data)) == (LONG, hashlib.sha256(data).hexdigest())
    assert files.get("k") == data


def test_a_file_that_came_out_shorter_than_it_was_sent_is_not_kept(
    files: ObjectFiles, server: Door, monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as patch:
        patch.setattr(ObjectFiles, "facts", lambda _files, _key: type("Facts", (), {"size": LONG - 1}))
        with pytest.raises(StorageUnreachable, match="bytes of"):
            files.put_stream("k", io.BytesIO(bytes(LONG)))
    assert list(files.keys()) == []


def test_a_bucket_that_was_removed_is_no_missing_file(object_server: str) -> None:
    files = ObjectFiles("s3://nobodys-bucket", object_server)
    for ask in (lambda: files.get("k"), lambda: files.put("k", b""), lambda: list(files.keys())):
        with pytest.raises(StorageUnreachable):
            ask()


def test_a_file_is_not_touched_but_put_again(files: ObjectFiles) -> None:
    files.put("k", b"x")
    assert not files.touch("k")


def test_libraries_in_one_bucket_do_not_see_each_other(files: ObjectFiles, server: Door) -> None:
    files.put("k", b"x")
    other = ObjectFiles(f"s3://{BUCKET}/another", server.address)
    assert list(other.keys()) == []
    with pytest.raises(FileMissing):
        other.get("k")
