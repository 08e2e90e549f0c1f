"""A packed job needs no file of the machine that packed it."""

import pickle
import subprocess
import sys
from pathlib import Path

import pytest

from index.errors import FileMissing
from index.local_files import LocalFiles
from index.object_files import ObjectFiles
from service.jobs.carrying import packed
from service.jobs.describing import FilesOnDisk, KeptFiles
from tests import children


def test_files_go_along_and_other_arguments_stay_as_they_are(tmp_path: Path) -> None:
    file = tmp_path / "a.ply"
    file.write_bytes(b"sent")
    store = LocalFiles(tmp_path / "files")
    store.put("uploads/1/0", b"kept")
    args = FilesOnDisk({"a.ply": file}), KeptFiles(store, {"b.ply": "uploads/1/0"}), {"a": 1}, 2
    payload = packed(children.add, args)
    file.unlink()
    store.delete("uploads/1/0")
    function, unpacked = pickle.loads(payload)  # noqa: S301 - made above
    assert function is children.add
    assert unpacked == ({"a.ply": b"sent"}, {"b.ply": b"kept"}, {"a": 1}, 2)


def test_files_in_a_bucket_stay_there() -> None:
    kept = KeptFiles(ObjectFiles("s3://bucket/prefix", "http://127.0.0.1:1"), {"a.ply": "uploads/1/0"})
    _, (unpacked,) = pickle.loads(packed(children.add, (kept,)))  # noqa: S301 - made above
    assert isinstance(unpacked, KeptFiles)
    assert list(unpacked) == ["a.ply"]


def test_a_file_that_is_gone_is_told(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        packed(children.add, (FilesOnDisk({"a.ply": tmp_path / "a.ply"}),))
    with pytest.raises(FileMissing):
        packed(children.add, (KeptFiles(LocalFiles(tmp_path), {"a.ply": "uploads/1/0"}),))


def test_running_a_packed_job_loads_nothing_of_dask() -> None:
    payload = packed(children.add, (2, 3))
    script = (
        "import sys\n"
        "from service.jobs.carrying import run_packed\n"
        f"print(run_packed({payload!r}), 'distributed' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", script], check=True, capture_output=True, text=True)
    assert done.stdout.split() == ["5", "False"]
