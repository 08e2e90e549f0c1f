"""Temporary files go, however their owner went."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from service.intake.incoming import Incoming


def folders(root: Path) -> list[Path]:
    return [path for path in root.iterdir() if path.is_dir()]


def test_a_scratch_folder_is_gone_afterwards_even_after_an_error(tmp_path: Path) -> None:
    incoming = Incoming(tmp_path)
    with pytest.raises(KeyError), incoming.scratch() as folder:  # noqa: PT012 - the block is what raises
        (folder / "half").write_bytes(b"x")
        raise KeyError
    assert not folder.exists()
    incoming.close()
    assert folders(tmp_path) == []


def test_what_a_killed_process_left_is_swept_by_the_next(tmp_path: Path) -> None:
    script = (
        "import os, pathlib, sys; from service.intake.incoming import Incoming\n"
        "incoming = Incoming(pathlib.Path(sys.argv[1]))\n"
        "with incoming.scratch() as folder:\n"
        "    (folder / 'half').write_bytes(b'x')\n"
        "    os.kill(os.getpid(), 9)\n"
    )
    where = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[1])}
    subprocess.run([sys.executable, "-c", script, tmp_path], env=where, check=False)
    left = folders(tmp_path)
    assert len(left) == 1
    incoming = Incoming(tmp_path)
    assert folders(tmp_path) == [incoming.folder]
    incoming.close()


def test_a_living_process_keeps_its_folder(tmp_path: Path) -> None:
    first = Incoming(tmp_path)
    with first.scratch() as folder:
        second = Incoming(tmp_path)
        assert folder.is_dir()
        second.close()
    first.close()
