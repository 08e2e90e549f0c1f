"""A child reads the files itself and answers with numbers."""

from pathlib import Path

import pytest

from service.jobs.describing import FilesOnDisk, describe_files
from tests.fakes import coloured_triangle
from worker.describe import describe
from worker.errors import MeshError
from worker.parameters import Parameters
from worker.reading.limits import Limits
from worker.reading.upload import Upload


def test_files_are_read_when_they_are_asked_for(tmp_path: Path) -> None:
    files = FilesOnDisk({"a": tmp_path / "a", "b": tmp_path / "b"})
    (tmp_path / "a").write_bytes(b"later")
    assert (list(files), len(files), files["a"]) == (["a", "b"], 2, b"later")
    with pytest.raises(FileNotFoundError):
        files["b"]


def test_stored_files_are_described_as_their_bytes_would_be(tmp_path: Path) -> None:
    path = tmp_path / "0"
    path.write_bytes(coloured_triangle())
    stored = describe_files({"a.ply": path}, False, Parameters(), Limits())
    sent = describe(Upload(files={"a.ply": coloured_triangle()}))
    assert stored.facts == sent.facts
    for name, block in sent.blocks.items():
        assert stored.blocks[name].tobytes() == block.tobytes()


def test_a_refusal_passes_through(tmp_path: Path) -> None:
    path = tmp_path / "0"
    path.write_bytes(b"ply")
    with pytest.raises(MeshError):
        describe_files({"a.ply": path}, False, Parameters(), Limits())
