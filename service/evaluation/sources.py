"""Where meshes come from: files of a folder, and shapes made by code."""

from collections.abc import Iterator, Mapping
from pathlib import Path

from service.evaluation.folder import MESHES
from service.jobs.describing import FilesOnDisk
from service.samples.variety import random_creature
from worker.reading.mesh import Mesh
from worker.reading.upload import Upload, read_mesh

MADE = "made:"  # before the number of a shape that is made by code
SEED = 1102  # of those; the shipped vocabulary is learnt from others


def read_source(folder: Path, source: str) -> Mesh:
    """Read one mesh.

    Parameters
    ----------
    folder : Path
        Of the evaluation.
    source : str
        A path below it, or MADE and a number.

    Raises
    ------
    MeshError
        Where it is refused.
    """
    return read_mesh(Upload(files=files_of(folder, source), allow_untextured=True))


def files_of(folder: Path, source: str) -> Mapping[str, bytes]:
    """Return a source's files: the mesh, and for an OBJ what lies beside and below it that is no mesh."""
    if source.startswith(MADE):
        return random_creature(int(source.removeprefix(MADE)), SEED).files
    mesh = folder / source
    return FilesOnDisk({mesh.name: mesh, **companions_of(mesh)})


def companions_of(mesh: Path) -> dict[str, Path]:
    """Return what a mesh may refer to: name relative to it → path."""
    if mesh.suffix.lower() != ".obj":
        return {}
    return {path.relative_to(mesh.parent).as_posix(): path for path in _no_meshes(mesh.parent)}


def _no_meshes(folder: Path) -> Iterator[Path]:
    return (
        path for path in sorted(folder.rglob("*")) if path.is_file() and path.suffix.lower() not in MESHES
    )
