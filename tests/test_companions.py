"""A mesh brings what it names, from its folder and from nowhere else."""

import io
from pathlib import Path

from PIL import Image

from service.commands.companions import Companions
from service.commands.discovery import find_sources
from worker.reading.limits import Limits

OBJ = "mtllib {library}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl skin\nf 1/1 2/2 3/3\n"


def _png() -> bytes:
    file = io.BytesIO()
    Image.new("RGB", (4, 4), "red").save(file, "PNG")
    return file.getvalue()


def _write(root: Path, place: str, library: str, image: str) -> None:
    mesh = root / place
    mesh.parent.mkdir(parents=True, exist_ok=True)
    mesh.write_text(OBJ.format(library=library))
    found = mesh.parent / library
    found.parent.mkdir(parents=True, exist_ok=True)
    found.write_text(f"newmtl skin\nmap_Kd {image}\n")


def _names(folder: Path, number: int = 0) -> list[str]:
    source = find_sources([folder])[0]
    return sorted(Companions(source, Limits()).files_of(source.meshes[number]))


def test_an_obj_brings_its_materials_and_images_only(tmp_path: Path) -> None:
    _write(tmp_path, "cup.obj", "cup.mtl", "cup.png")
    for name in ("cup.png", "unrelated.png", "other.mtl"):
        (tmp_path / name).write_bytes(_png())
    assert _names(tmp_path) == ["cup.mtl", "cup.obj", "cup.png"]
    assert _names(tmp_path / "cup.obj") == ["cup.mtl", "cup.obj", "cup.png"]


def test_names_start_where_all_files_are(tmp_path: Path) -> None:
    _write(tmp_path, "a/b/cup.obj", "cup.mtl", "../images/cup.png")
    (tmp_path / "a/images").mkdir()
    (tmp_path / "a/images/cup.png").write_bytes(_png())
    assert _names(tmp_path) == ["b/cup.mtl", "b/cup.obj", "images/cup.png"]
    assert _names(tmp_path / "a") == ["b/cup.mtl", "b/cup.obj", "images/cup.png"]


def test_a_plain_ply_comes_alone(tmp_path: Path) -> None:
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "a.ply").write_bytes(b"ply\n")
    (tmp_path / "b.png").write_bytes(_png())
    assert _names(tmp_path) == ["a.ply"]


def test_an_image_outside_the_folder_is_not_brought(tmp_path: Path) -> None:
    (tmp_path / "secret.png").write_bytes(_png())
    _write(tmp_path / "given", "cup.obj", "cup.mtl", "../secret.png")
    assert _names(tmp_path / "given") == ["cup.mtl", "cup.obj"]


def test_a_damaged_image_is_brought_so_that_its_fault_is_told(tmp_path: Path) -> None:
    _write(tmp_path, "cup.obj", "cup.mtl", "cup.png")
    (tmp_path / "cup.png").write_bytes(b"no image")
    assert "cup.png" in _names(tmp_path)
