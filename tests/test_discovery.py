"""Meshes are found below what the user names, and nothing outside is."""

from pathlib import Path

import pytest

from service.commands.discovery import find_sources
from service.commands.failures import CommandFailed


def _touch(root: Path, *places: str) -> None:
    for place in places:
        (root / place).parent.mkdir(parents=True, exist_ok=True)
        (root / place).write_bytes(b"x")


def test_meshes_of_a_folder_are_named_by_their_place(tmp_path: Path) -> None:
    _touch(tmp_path, "b/two.OBJ", "b/two.mtl", "a.ply", "c.zip", "notes.txt")
    source = find_sources([tmp_path])[0]
    assert [mesh.name for mesh in source.meshes] == ["a.ply", "b/two.OBJ", "c.zip"]
    assert [mesh.path for mesh in source.meshes] == [tmp_path / mesh.place for mesh in source.meshes]
    assert set(source.others) == {"b/two.mtl", "notes.txt"}


def test_a_single_file_keeps_its_stem_as_name(tmp_path: Path) -> None:
    _touch(tmp_path, "cup.obj", "other.obj", "textures/cup.png")
    source = find_sources([tmp_path / "cup.obj"])[0]
    assert [(mesh.place, mesh.name) for mesh in source.meshes] == [("cup.obj", None)]
    assert source.others == ("textures/cup.png",)


def test_hidden_files_are_left_out(tmp_path: Path) -> None:
    _touch(tmp_path, ".cache/a.ply", "__MACOSX/b.ply", "._c.ply", "d.ply")
    assert [mesh.place for mesh in find_sources([tmp_path])[0].meshes] == ["d.ply"]


def test_links_out_of_the_folder_are_left_out(tmp_path: Path) -> None:
    _touch(tmp_path, "outside/secret.ply", "inside/real.ply")
    (tmp_path / "inside" / "link.ply").symlink_to(tmp_path / "outside" / "secret.ply")
    (tmp_path / "inside" / "same.ply").symlink_to(tmp_path / "inside" / "real.ply")
    found = find_sources([tmp_path / "inside"])[0]
    assert [mesh.place for mesh in found.meshes] == ["real.ply", "same.ply"]


def test_what_is_not_there_is_refused(tmp_path: Path) -> None:
    with pytest.raises(CommandFailed, match="there is no file or folder"):
        find_sources([tmp_path / "nothere"])
