"""An address says where files are kept; a wrong one is refused in words."""

from pathlib import Path

import pytest

from index.errors import StorageUnreachable, UnknownStorage
from index.file_places import open_files
from tests.storages import BUCKET


def test_without_an_address_and_with_that_of_a_folder_files_lie_in_a_folder(tmp_path: Path) -> None:
    assert open_files(None, tmp_path / "files").folder == tmp_path / "files"
    files = open_files(f"file://{tmp_path}/an%20other", tmp_path / "files")
    files.put("a/b", b"x")
    assert (tmp_path / "an other" / "a" / "b").read_bytes() == b"x"


def test_a_folder_is_the_same_wherever_another_process_starts(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert open_files(None, Path("files")).folder == tmp_path / "files"


@pytest.mark.parametrize(
    "address", ["gs://bucket", "/a/folder", "folder", "", "file://host/folder", "file:///", "http://x/y"]
)
def test_other_kinds_of_places_are_refused(address: str, tmp_path: Path) -> None:
    with pytest.raises(UnknownStorage, match="file:///FOLDER or s3://BUCKET/PREFIX"):
        open_files(address, tmp_path)


@pytest.mark.parametrize(
    "address",
    ["s3://", "s3://a", "s3://Bucket", "s3://key:secret@bucket", "s3://bucket/a?b=c", "s3://bucket//a"],
)
def test_what_is_no_address_of_a_bucket_is_refused_without_repeating_it(address: str, tmp_path: Path) -> None:
    with pytest.raises(UnknownStorage, match="s3://BUCKET") as caught:
        open_files(address, tmp_path)
    assert "secret" not in str(caught.value)


def test_a_bucket_that_is_not_there_is_refused(object_server: str, tmp_path: Path) -> None:
    with pytest.raises(UnknownStorage, match="no bucket for s3://nobodys-bucket/a"):
        open_files("s3://nobodys-bucket/a", tmp_path)
    open_files(f"s3://{BUCKET}/", tmp_path)


def test_a_server_that_is_not_there_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("AWS_ENDPOINT_URL", "http://127.0.0.1:1")
    with pytest.raises(StorageUnreachable):
        open_files("s3://bucket/a", tmp_path)


def test_a_setting_of_the_client_that_is_none_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("AWS_CHECKSUM_ALGORITHM", "none of them")
    with pytest.raises(UnknownStorage, match="AWS_"):
        open_files("s3://bucket/a", tmp_path)
