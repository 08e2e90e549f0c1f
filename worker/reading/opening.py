"""The files that were sent: loose or in a zip, by normalised path, one of them the mesh."""

import posixpath
from collections.abc import Iterable, Mapping

from worker.errors import Code, MeshError
from worker.reading.archive import is_hidden
from worker.reading.references import normalise
from worker.reading.showing import shown

_SUFFIXES = (".ply", ".obj")


def archive_name(sent: Mapping[str, bytes]) -> str | None:
    """Return the name of the zip, or None where loose files came.

    Raises
    ------
    MeshError
        BAD_ARCHIVE where a zip came together with other files.
    """
    archives = [name for name in sent if name.lower().endswith(".zip")]
    if archives and len(sent) > 1:
        raise MeshError(
            Code.BAD_ARCHIVE, f"The zip {shown(archives[0])} came with other files; send it alone."
        )
    return archives[0] if archives else None


def sent_files(sent: Mapping[str, bytes]) -> dict[str, bytes]:
    """Return loose files by normalised path.

    Raises
    ------
    MeshError
        UNSAFE_REFERENCE
    """
    files = {}
    for name, content in sent.items():
        path = normalise(name)
        if path is None:
            raise MeshError(Code.UNSAFE_REFERENCE, f"The file name {shown(name)} points outside the upload.")
        if not is_hidden(path):
            files[path] = content
    return files


def mesh_name(files: Iterable[str]) -> str:
    """Return the one name that is a mesh's.

    Raises
    ------
    MeshError
        NO_MESH, SEVERAL_MESHES
    """
    listed = list(files)
    meshes = sorted(name for name in listed if name.lower().endswith(_SUFFIXES))
    if not meshes:
        found = ", ".join(shown(posixpath.basename(name)) for name in sorted(listed)[:3]) or "nothing"
        raise MeshError(Code.NO_MESH, f"Expected one .ply or .obj file, found {found}.")
    if len(meshes) > 1:
        raise MeshError(
            Code.SEVERAL_MESHES,
            f"Expected one mesh, found {len(meshes)}: {shown(meshes[0])}, {shown(meshes[1])} …",
        )
    return meshes[0]
