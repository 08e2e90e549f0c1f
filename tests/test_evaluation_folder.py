from pathlib import Path

import pytest

from service.evaluation.folder import BadFolder, Model, read_folder


def folder_of(path: Path, *names: str) -> Path:
    for name in names:
        (path / name).parent.mkdir(parents=True, exist_ok=True)
        (path / name).touch()
    return path


def test_models_have_a_rest_pose_and_others_by_name(tmp_path: Path) -> None:
    folder_of(tmp_path, *(f"posed/{name}/pose_{k:02d}.ply" for name in ("b", "a") for k in (2, 0, 1)))
    assert read_folder(tmp_path).models == tuple(
        Model(
            name=name,
            rest=f"posed/{name}/pose_00.ply",
            others=(f"posed/{name}/pose_01.ply", f"posed/{name}/pose_02.ply"),
        )
        for name in ("a", "b")
    )


def test_what_is_no_pose_is_left_alone(tmp_path: Path) -> None:
    names = ("pose_00.OBJ", "pose_00.mtl", "skin.png", "draft.ply", "notes.txt")
    folder_of(tmp_path, *(f"posed/a/{name}" for name in names), "posed/rest.ply", "posed/b/pose_01.ply")
    assert read_folder(tmp_path).models == (Model(name="a", rest="posed/a/pose_00.OBJ", others=()),)


def test_clutter_is_every_mesh_beside_the_models(tmp_path: Path) -> None:
    folder_of(tmp_path, "posed/a/pose_00.ply", "clutter/z.zip", "clutter/b.obj", "clutter/b.mtl", "c.ply")
    assert read_folder(tmp_path).clutter == ("clutter/b.obj", "clutter/z.zip")


def test_there_need_be_no_clutter(tmp_path: Path) -> None:
    assert read_folder(folder_of(tmp_path, "posed/a/pose_00.zip")).clutter == ()


@pytest.mark.parametrize("names", [(), ("clutter/a.ply",), ("posed/a/pose_01.ply",), ("posed/pose_00.ply",)])
def test_a_folder_without_a_rest_pose_is_refused_in_plain_words(
    names: tuple[str, ...], tmp_path: Path
) -> None:
    with pytest.raises(BadFolder, match=r"holds no posed/NAME/pose_00\.ply"):
        read_folder(folder_of(tmp_path, *names))
    with pytest.raises(BadFolder):
        read_folder(tmp_path / "nothere")
