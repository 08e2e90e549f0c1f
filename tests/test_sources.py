from pathlib import Path

import numpy as np
import pytest

from service.evaluation.sources import MADE, SEED, files_of, read_source
from service.samples.variety import random_creature
from tests.fakes import coloured_triangle
from tests.mesh_files import TEXTURED, png
from worker.errors import Code, MeshError


def textured(folder: Path) -> None:
    """Write an OBJ with its material and image below it, among other things."""
    (folder / "maps").mkdir()
    (folder / "m.obj").write_text(TEXTURED)
    (folder / "m.mtl").write_text("newmtl a\nmap_Kd maps/skin.png\n")
    (folder / "maps" / "skin.png").write_bytes(png())
    (folder / "other.ply").write_bytes(coloured_triangle())
    (folder / "other.OBJ").write_text(TEXTURED)


def test_a_ply_comes_alone(tmp_path: Path) -> None:
    textured(tmp_path)
    assert dict(files_of(tmp_path, "other.ply")) == {"other.ply": coloured_triangle()}


def test_an_obj_brings_materials_and_images_but_no_other_mesh(tmp_path: Path) -> None:
    textured(tmp_path)
    assert set(files_of(tmp_path, "m.obj")) == {"m.obj", "m.mtl", "maps/skin.png"}
    (texture,) = read_source(tmp_path, "m.obj").textures
    assert texture.shape == (2, 2, 3)


def test_paths_are_relative_to_the_folder(tmp_path: Path) -> None:
    below = tmp_path / "posed" / "a"
    below.mkdir(parents=True)
    textured(below)
    assert len(read_source(tmp_path, "posed/a/m.obj").textures) == 1
    assert len(read_source(tmp_path, "posed/a/other.ply").faces) == 2


def test_a_missing_image_does_not_refuse_a_shape(tmp_path: Path) -> None:
    textured(tmp_path)
    (tmp_path / "maps" / "skin.png").unlink()
    assert len(read_source(tmp_path, "m.obj").faces) == 1


def test_a_broken_file_is_refused_by_its_code(tmp_path: Path) -> None:
    (tmp_path / "a.ply").write_bytes(b"")
    with pytest.raises(MeshError) as refusal:
        read_source(tmp_path, "a.ply")
    assert refusal.value.code is Code.EMPTY


def test_shapes_made_by_code_need_no_file(tmp_path: Path) -> None:
    first, again, other = (read_source(tmp_path, f"{MADE}{number}") for number in (5, 5, 6))
    np.testing.assert_array_equal(first.vertices, again.vertices)
    assert len(first.vertices) != len(other.vertices) or (first.vertices != other.vertices).any()
    assert dict(files_of(tmp_path, f"{MADE}5")) == random_creature(5, SEED).files
