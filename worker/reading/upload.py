"""What came in becomes a mesh: the one way into reading."""

import posixpath
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from worker.errors import Code, MeshError
from worker.reading.archive import unpack
from worker.reading.limits import Limits
from worker.reading.mesh import Mesh
from worker.reading.obj import read_obj
from worker.reading.painting import paint
from worker.reading.ply import read_ply
from worker.reading.references import normalise

SUFFIXES = (".ply", ".obj")


@dataclass(frozen=True, kw_only=True, eq=False)
class Upload:
    """The files that were sent together."""

    files: Mapping[str, bytes]  # relative path as sent → content; or one zip alone
    allow_untextured: bool = False  # accept where a named MTL or image was not sent


def read_mesh(upload: Upload, limits: Limits = Limits()) -> Mesh:  # noqa: B008 -- frozen
    """Read the one mesh of an upload with its colours.

    Raises
    ------
    MeshError
        With the reason why it is refused; nothing else is raised, whatever the bytes.
    """
    files = open_files(upload.files, limits)
    name = mesh_name(files)
    if name.lower().endswith(".ply"):
        surface = read_ply(files[name], name)
    else:
        surface = read_obj(files[name], name, files, allow_untextured=upload.allow_untextured)
    return paint(surface, files, allow_untextured=upload.allow_untextured, limits=limits)


def open_files(sent: Mapping[str, bytes], limits: Limits) -> dict[str, bytes]:
    """Return the files by normalised path, unpacked where one zip came.

    Raises
    ------
    MeshError
        UNSAFE_REFERENCE, and those of `unpack`.
    """
    archives = [name for name in sent if name.lower().endswith(".zip")]
    if archives and len(sent) > 1:
        raise MeshError(Code.BAD_ARCHIVE, f"The zip “{archives[0]}” came with other files; send it alone.")
    if archives:
        return unpack(sent[archives[0]], limits)
    files = {}
    for name, content in sent.items():
        path = normalise(name)
        if path is None:
            raise MeshError(Code.UNSAFE_REFERENCE, f"The file name “{name}” points outside the upload.")
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
    meshes = sorted(name for name in listed if name.lower().endswith(SUFFIXES))
    if not meshes:
        shown = ", ".join(posixpath.basename(name) for name in sorted(listed)[:3]) or "nothing"
        raise MeshError(Code.NO_MESH, f"Expected one .ply or .obj file, found {shown}.")
    if len(meshes) > 1:
        raise MeshError(
            Code.SEVERAL_MESHES, f"Expected one mesh, found {len(meshes)}: {meshes[0]}, {meshes[1]} …"
        )
    return meshes[0]


def inspect_upload(upload: Upload, limits: Limits = Limits()) -> None:  # noqa: B008 -- frozen
    """Refuse what can be known without reading the mesh.

    Raises
    ------
    MeshError
        The same codes as `read_mesh`, of which it finds only some.
    """
    mesh_name(open_files(upload.files, limits))
