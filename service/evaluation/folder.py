"""A folder of shapes and poses: what an evaluation is made of."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

MESHES = (".ply", ".obj", ".zip")
REST = "pose_00"


class BadFolder(Exception):
    """The folder does not hold what an evaluation needs."""


@dataclass(frozen=True, kw_only=True)
class Model:
    """A shape and its poses; paths are relative to the folder."""

    name: str
    rest: str  # the null shape
    others: tuple[str, ...]  # other poses, by name


@dataclass(frozen=True, kw_only=True)
class Folder:
    """Models to be found, among things that are not."""

    path: Path
    models: tuple[Model, ...]
    clutter: tuple[str, ...]  # paths relative to the folder


def read_folder(path: Path) -> Folder:
    """List ``posed/NAME/pose_XX.*`` and ``clutter/*``.

    Raises
    ------
    BadFolder
        Where there is no ``posed/NAME/pose_00.*``.
    """
    models = tuple(_models(path))
    if not models:
        raise BadFolder(f"{path} holds no posed/NAME/{REST}.ply (or .obj, .zip), from which queries are made")
    return Folder(path=path, models=models, clutter=_meshes(path, path / "clutter"))


def _models(path: Path) -> Iterator[Model]:
    for folder in sorted(path.glob("posed/*/")):
        poses = [pose for pose in _meshes(path, folder) if Path(pose).stem.startswith("pose_")]
        rest = [pose for pose in poses if Path(pose).stem == REST]
        if rest:
            others = tuple(pose for pose in poses if pose != rest[0])
            yield Model(name=folder.name, rest=rest[0], others=others)


def _meshes(path: Path, folder: Path) -> tuple[str, ...]:
    if not folder.is_dir():
        return ()
    found = (file for file in folder.iterdir() if file.suffix.lower() in MESHES)
    return tuple(sorted(file.relative_to(path).as_posix() for file in found))
