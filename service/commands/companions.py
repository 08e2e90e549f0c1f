"""The materials and images that a mesh brings along, found in its folder and nowhere else."""

import contextlib
import os.path
from collections.abc import Iterator, Mapping
from pathlib import Path

from service.commands.discovery import Found, Source
from worker.errors import MeshError
from worker.reading.inspection import inspect_files
from worker.reading.limits import Limits
from worker.reading.references import SentFiles


class Companions:
    """Looks in one source for what its meshes name.

    Parameters
    ----------
    source : Source
    limits : Limits
    """

    def __init__(self, source: Source, limits: Limits) -> None:
        self._limits = limits
        self._folder = _ReadFiles(source)
        self._files = SentFiles(self._folder)

    def files_of(self, mesh: Found) -> dict[str, Path]:
        """Return the files to send with a mesh, itself included: name → path.

        Names start at the deepest folder that holds them all, so that one mesh has the same content
        however it was reached.
        """
        places = [mesh.place]
        if not mesh.place.lower().endswith(".zip"):
            places = self._read_for(mesh.place)
        start = os.path.commonpath([Path(place).parent for place in places])
        return {Path(place).relative_to(start or ".").as_posix(): mesh.root / place for place in places}

    def _read_for(self, place: str) -> list[str]:
        """Return what reading looks into for a mesh: its companions are exactly that."""
        self._folder.read.clear()
        with contextlib.suppress(MeshError):  # it is raised again, and told, when the files are accepted
            inspect_files(self._files, place, self._limits, allow_untextured=True)
        return list(dict.fromkeys([place, *self._folder.read]))


class _ReadFiles(Mapping[str, bytes]):
    """The files of a source, read when asked for; remembers which were."""

    def __init__(self, source: Source) -> None:
        self._root = source.root
        meshes = [mesh.place for mesh in source.meshes]
        self._places = dict.fromkeys([*meshes, *source.others])
        self.read: list[str] = []  # in the order of reading

    def __getitem__(self, place: str) -> bytes:
        content = (self._root / place).read_bytes() if place in self._places else None
        if content is None:
            raise KeyError(place)
        self.read.append(place)
        return content

    def __contains__(self, place: object) -> bool:
        return place in self._places

    def __iter__(self) -> Iterator[str]:
        return iter(self._places)

    def __len__(self) -> int:
        return len(self._places)
