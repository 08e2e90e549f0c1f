"""What an export and an import cost, beside copying the same folder with tar and cp.

`python -m benchmarks.backing_up --shapes 2000`; needs five times the library's size on the disk.
"""

import argparse
import hashlib
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from sqlalchemy import update

from benchmarks.made_library import make_library
from index.database import writing
from index.tables import FileRow
from service.library import Library
from service.settings import Settings
from service.storage import PREVIEW, SIGNATURES, THUMBNAIL, derived_key, upload_key

SIZES = {THUMBNAIL: 15_000, PREVIEW: 60_000, SIGNATURES: 500_000}  # bytes, of a usual shape
UPLOADED = 150_000  # bytes
PACK = 'tar cf "$1" -C "$2" . && sync "$1"'
COPY = 'cp -r "$2" "$1" && sync'
FAIENCE = (sys.executable, "-c", "from service.commands.main import main; main()")


def fill(folder: Path, n_shapes: int) -> None:
    """Make a library whose shapes have all their files."""
    random = np.random.default_rng(1)
    ids = make_library(folder, n_shapes)
    library = Library.open(Settings(data_dir=folder))
    for shape_id in ids:
        data = random.bytes(UPLOADED)
        _put(library, upload_key(shape_id, 0), data)
        for name, size in SIZES.items():
            _put(library, derived_key(shape_id, name), random.bytes(size))
        sha256 = hashlib.sha256(data).hexdigest()
        with writing(library.engine) as session:
            row = update(FileRow).where(FileRow.shape_id == shape_id)
            session.execute(row.values(size=UPLOADED, sha256=sha256))
    library.close()


def _put(library: Library, key: str, data: bytes) -> None:
    library.files.put(key, data, flushed=False)  # durable is not needed here, and slow


def timed(*command: str | Path) -> tuple[float, float, float]:
    """Run a command; return its seconds, those of a processor, and the largest memory it had, in MB."""
    os.sync()
    start, busy, largest = time.perf_counter(), _busy_seconds(), 0.0
    with subprocess.Popen([*map(str, command)], stdout=subprocess.DEVNULL) as process:
        while process.poll() is None:
            largest = max(largest, _largest_memory(process.pid))
            time.sleep(0.01)
    if process.returncode != 0:
        raise RuntimeError(f"{command} ended with {process.returncode}")
    return time.perf_counter() - start, _busy_seconds() - busy, largest


def _busy_seconds() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _largest_memory(pid: int) -> float:
    lines = Path(f"/proc/{pid}/status").read_text().splitlines()
    return max((int(line.split()[1]) / 1000 for line in lines if line.startswith("VmHWM")), default=0.0)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--shapes", type=int, default=2000)
    parser.add_argument("--folder", type=Path, help="on the disk to be measured")
    chosen = parser.parse_args()
    with tempfile.TemporaryDirectory(dir=chosen.folder) as name:
        place = Path(name)
        fill(place / "library", chosen.shapes)
        library, packed = place / "library", place / "library.tar"
        steps: dict[str, tuple[str | Path, ...]] = {
            "tar cf and sync (baseline of export)": ("sh", "-c", PACK, "sh", place / "plain.tar", library),
            "faience export": (*FAIENCE, "export", packed, "--data-dir", library),
            "cp -r and sync (baseline of import)": ("sh", "-c", COPY, "sh", place / "copy", library),
            "faience import": (*FAIENCE, "import", packed, "--data-dir", place / "imported"),
            "starting alone": (sys.executable, "-c", "import service.commands.backing_up"),
        }
        for title, command in steps.items():
            seconds, busy, memory = timed(*command)
            print(f"{title:36} {seconds:8.2f} s, busy {busy:6.2f} s, {memory:6.0f} MB", flush=True)
        print(f"{chosen.shapes} shapes, {packed.stat().st_size / 1e6:.0f} MB")


if __name__ == "__main__":
    main()
