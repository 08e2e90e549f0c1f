"""A packed job needs no file of the machine that packed it."""

import pickle
import subprocess
import sys
from pathlib import Path

import pytest

from service.jobs.carrying import packed
from tests import children


def test_files_go_along_and_other_arguments_stay_as_they_are(tmp_path: Path) -> None:
    file = tmp_path / "a.ply"
    file.write_bytes(b"content")
    payload = packed(children.add, ({"a.ply": file}, {"a": 1}, 2))
    file.unlink()
    function, (files, mapping, number) = pickle.loads(payload)  # noqa: S301 - made above
    assert function is children.add
    assert files["a.ply"].read_bytes() == b"content"
    assert (mapping, number) == ({"a": 1}, 2)


def test_a_file_that_is_gone_is_told(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        packed(children.add, ({"a.ply": tmp_path / "a.ply"},))


def test_running_a_packed_job_loads_nothing_of_dask() -> None:
    payload = packed(children.add, (2, 3))
    script = (
        "import sys\n"
        "from service.jobs.carrying import run_packed\n"
        f"print(run_packed({payload!r}), 'distributed' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", script], check=True, capture_output=True, text=True)
    assert done.stdout.split() == ["5", "False"]
