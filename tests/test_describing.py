"""A child reads the files itself and answers with numbers."""

import pickle
from importlib import import_module
from pathlib import Path

import pytest

from index.file_places import open_files
from service.jobs.describing import FilesOnDisk, KeptFiles, describe_files
from tests.fakes import coloured_triangle
from tests.storages import ENVIRONMENT, PLACES
from worker.describe import describe
from worker.errors import MeshError
from worker.parameters import Parameters
from worker.reading.limits import Limits
from worker.reading.upload import Upload

pytestmark = pytest.mark.usefixtures("storage")  # with files in a folder and in a bucket

PASSWORD = ENVIRONMENT["AWS_SECRET_ACCESS_KEY"].encode()


def test_files_are_read_when_they_are_asked_for(tmp_path: Path) -> None:
    files = FilesOnDisk({"a": tmp_path / "a", "b": tmp_path / "b"})
    (tmp_path / "a").write_bytes(b"later")
    assert (list(files), len(files), files["a"]) == (["a", "b"], 2, b"later")
    with pytest.raises(FileNotFoundError):
        files["b"]


def test_stored_files_are_described_as_their_bytes_would_be(tmp_path: Path) -> None:
    files = open_files(PLACES.url(tmp_path), tmp_path)
    files.put("uploads/a/0", coloured_triangle())
    stored = describe_files(KeptFiles(files, {"a.ply": "uploads/a/0"}), False, Parameters(), Limits())
    sent = describe(Upload(files={"a.ply": coloured_triangle()}))
    assert stored.facts == sent.facts
    for name, block in sent.blocks.items():
        assert stored.blocks[name].tobytes() == block.tobytes()


def test_a_refusal_passes_through() -> None:
    with pytest.raises(MeshError):
        describe_files({"a.ply": b"ply"}, False, Parameters(), Limits())


@pytest.mark.parametrize("pickler", ["pickle", "cloudpickle"])
def test_what_is_handed_to_another_process_is_small_and_reads_there(pickler: str, tmp_path: Path) -> None:
    files = open_files(PLACES.url(tmp_path), tmp_path)
    files.put("uploads/a/0", bytes(10**6))
    sent: bytes = import_module(pickler).dumps(KeptFiles(files, {"a.ply": "uploads/a/0"}))
    assert len(sent) < 1000
    assert PASSWORD not in sent
    again = pickle.loads(sent)  # noqa: S301 - our own
    assert list(again) == ["a.ply"]
    files.put("uploads/a/0", b"later")
    assert again["a.ply"] == b"later"
