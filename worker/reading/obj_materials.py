"""The materials that an OBJ file names, found in the upload."""

import re
from collections.abc import Iterable, Set

from worker.errors import Code, MeshError
from worker.reading.contents import Material, among
from worker.reading.mtl import read_mtl
from worker.reading.references import SentFiles
from worker.reading.showing import shown


def find_materials(
    libraries: Iterable[str], used: Set[str], named_by: str, files: SentFiles, *, allow_untextured: bool
) -> tuple[dict[str, Material], list[str]]:
    """Read the material files that an OBJ file names.

    A file that was not sent is missed only where a face uses a material that no sent file defines.

    Parameters
    ----------
    libraries : Iterable[str]
        What stands after each mtllib.
    used : Set[str]
        Materials of faces.
    named_by : str
        Path of the OBJ file.
    files : SentFiles
        The upload.
    allow_untextured : bool
        Go on without files that were not sent.

    Returns
    -------
    materials : dict[str, Material]
        By name; where two files define one, the first named counts.
    warnings : list[str]

    Raises
    ------
    MeshError
        MISSING_TEXTURE, UNSAFE_REFERENCE, and those of `read_mtl`.
    """
    found, missing = _find_libraries(libraries, named_by, files, allow_untextured)
    materials: dict[str, Material] = {}
    for library in found:
        for name, material in read_mtl(files[library], library).items():
            materials.setdefault(name, material)
    undefined = used - materials.keys()
    if undefined and missing and not allow_untextured:
        raise MeshError(
            Code.MISSING_TEXTURE,
            f"{shown(named_by)} names the material file {shown(missing[0])}, which was not sent; "
            "send it with the mesh, or allow the mesh without its texture.",
        )
    return materials, [
        *among(missing, "material files were not sent"),
        *among(sorted(undefined - {""}), "materials are not defined in what was sent"),
    ]


def _find_libraries(
    libraries: Iterable[str], named_by: str, files: SentFiles, allow_untextured: bool
) -> tuple[list[str], list[str]]:
    """Return the material files that were sent, by path, and those that were not, as written."""
    found: dict[str, None] = {}
    missing: dict[str, None] = {}
    for library in libraries:
        for reference in library_names(library, named_by, files):
            try:
                path = files.find(reference, named_by)
            except MeshError:
                if not allow_untextured:
                    raise
                path = None
            if path is None:
                missing[reference] = None
            else:
                found[path] = None
    return list(found), list(missing)


def library_names(rest: str, named_by: str, files: SentFiles) -> list[str]:
    r"""Return the file names after mtllib: one that may hold blanks, or several.

    Blanks within a name may be written ``\ ``.
    """
    whole = rest.replace("\\ ", " ").strip().strip('"')
    if not whole or _is_sent(whole, named_by, files):
        return [whole] if whole else []
    return re.split(r"(?<=\.mtl)\s+", whole, flags=re.IGNORECASE)


def _is_sent(reference: str, named_by: str, files: SentFiles) -> bool:
    try:
        return files.find(reference, named_by) is not None
    except MeshError:
        return False
