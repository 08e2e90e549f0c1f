"""What came in becomes a mesh: the one way into reading."""

from collections.abc import Mapping
from dataclasses import dataclass

from worker.reading.archive import list_archive, unpack
from worker.reading.assembling import assemble
from worker.reading.inspection import inspect_files, inspect_ply
from worker.reading.limits import Limits
from worker.reading.mesh import Mesh
from worker.reading.obj import read_obj
from worker.reading.opening import archive_name, mesh_name, sent_files
from worker.reading.ply import read_ply
from worker.reading.references import SentFiles

_SMALL = 64_000_000  # bytes: what unpacks to more is inspected by its list alone


@dataclass(frozen=True, kw_only=True, eq=False)
class Upload:
    """The files that were sent together."""

    files: Mapping[str, bytes]  # relative path as sent → content; or one zip alone
    allow_untextured: bool = False  # accept where a named MTL or image was not sent


def read_mesh(upload: Upload, limits: Limits = Limits()) -> Mesh:
    """Read the one mesh of an upload with its colours.

    Parameters
    ----------
    upload : Upload
    limits : Limits
        What is refused before it is allocated.

    Raises
    ------
    MeshError
        With the reason why it is refused.
    """
    archive = archive_name(upload.files)
    contents = sent_files(upload.files) if archive is None else unpack(upload.files[archive], limits)
    name = mesh_name(contents)
    files = SentFiles(contents)
    if name.lower().endswith(".ply"):
        inspect_ply(files, name, limits, allow_untextured=upload.allow_untextured)
        surface = read_ply(files[name], name, limits)
    else:
        surface = read_obj(files[name], name, files, allow_untextured=upload.allow_untextured)
    return assemble(surface, files, allow_untextured=upload.allow_untextured, limits=limits)


def inspect_upload(upload: Upload, limits: Limits = Limits()) -> None:
    """Refuse what can be known cheaply, by headers and lists, without reading the mesh itself.

    What passes may still be refused by `read_mesh`, with the same codes.

    Parameters
    ----------
    upload : Upload
    limits : Limits

    Raises
    ------
    MeshError
        With the reason why it is refused.
    """
    archive = archive_name(upload.files)
    if archive is None:
        contents = sent_files(upload.files)
    else:
        sizes = list_archive(upload.files[archive], limits)
        mesh_name(sizes)
        if sum(sizes.values()) > _SMALL:
            return
        contents = unpack(upload.files[archive], limits)
    name = mesh_name(contents)
    inspect_files(SentFiles(contents), name, limits, allow_untextured=upload.allow_untextured)
