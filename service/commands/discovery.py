"""Which meshes lie in the files and folders that a user names."""

import os
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from service.commands.failures import CommandFailed

MESHES = (".ply", ".obj", ".zip")
DEPTH = 3  # folders below that of a single file in which its textures are looked for


@dataclass(frozen=True, kw_only=True)
class Found:
    """One mesh or archive that is to be indexed."""

    path: Path  # as the user would write it
    root: Path  # the folder whose files it may bring; nothing outside is ever read
    place: str  # its path below the root, with forward slashes
    name: str | None  # in the library; None: the stem of the file


@dataclass(frozen=True, kw_only=True)
class Source:
    """One argument of the command."""

    meshes: tuple[Found, ...]  # in the order of their paths
    root: Path  # the folder
    others: tuple[str, ...]  # files below the root that are no meshes: materials, images


def find_sources(paths: Iterable[Path]) -> list[Source]:
    """Look into every argument.

    Raises
    ------
    CommandFailed
        One of them does not exist.
    """
    sources = []
    for path in paths:
        if path.is_dir():
            sources.append(_folder(path))
        elif path.is_file():
            sources.append(_file(path))
        else:
            raise CommandFailed(f"there is no file or folder {path}")
    return sources


def _folder(root: Path) -> Source:
    places = sorted(_places(root))
    meshes = [
        Found(path=root / place, root=root, place=place, name=place)
        for place in places
        if place.lower().endswith(MESHES)
    ]
    return Source(meshes=tuple(meshes), root=root, others=_others(places))


def _file(path: Path) -> Source:
    mesh = Found(path=path, root=path.parent, place=path.name, name=None)
    alone = path.suffix.lower() == ".zip"
    others = () if alone else _others(sorted(_places(path.parent, DEPTH)))
    return Source(meshes=(mesh,), root=path.parent, others=others)


def _others(places: list[str]) -> tuple[str, ...]:
    return tuple(place for place in places if not place.lower().endswith(MESHES))


def _places(root: Path, depth: int | None = None) -> Iterator[str]:
    """Yield the files below a folder; hidden ones, and links that lead out of it, are left out."""
    inside = root.resolve()
    for folder, folders, files in os.walk(root):
        here = Path(folder)
        below = len(here.relative_to(root).parts)
        keep = depth is None or below < depth
        folders[:] = sorted(
            name for name in folders if keep and not name.startswith(".") and name != "__MACOSX"
        )
        for name in files:
            path = here / name
            linked_out = path.is_symlink() and not path.resolve().is_relative_to(inside)
            if not name.startswith(".") and not linked_out:
                yield path.relative_to(root).as_posix()
