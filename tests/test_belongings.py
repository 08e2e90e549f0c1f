"""Which files belong to a shape."""

from pathlib import Path

from index.dumping import Belongings
from index.local_files import LocalFiles
from index.shapes import StoredFile
from service.backup.belongings import made_prefix, needed_files, present_files

FILE = StoredFile(name="a.ply", key="uploads/u/0", size=1, sha256="ab")


def shape(ready: bool) -> Belongings:
    return Belongings(id="s", revision=1, ready=ready, files=(FILE,))


def test_a_shape_needs_its_uploads_and_a_ready_one_what_was_made_of_them() -> None:
    assert needed_files(shape(ready=False)) == {"uploads/u/0": FILE}
    made = dict.fromkeys(f"shapes/s/{name}" for name in ("thumbnail.png", "preview.glb", "signatures.npz"))
    assert needed_files(shape(ready=True)) == {"uploads/u/0": FILE, **made}


def test_what_is_kept_for_it_belongs_to_it_too(tmp_path: Path) -> None:
    files = LocalFiles(tmp_path)
    for key in ("shapes/s/later.bin", "shapes/s2/other.bin", "uploads/v/0"):
        files.put(key, b"x")
    (tmp_path / "shapes" / "s" / ".DS_Store").write_bytes(b"no key")
    assert present_files(files, shape(ready=False)) == {"uploads/u/0": FILE, "shapes/s/later.bin": None}


def test_the_prefix_ends_the_id() -> None:
    assert made_prefix("s") == "shapes/s/"
