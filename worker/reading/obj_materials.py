"""The materials that an OBJ file names, found in the upload."""

import re
from collections.abc import Iterable, Mapping, Set

from worker.errors import Code, MeshError
from worker.reading.mtl import read_mtl
from worker.reading.references import find_file
from worker.reading.surface import Material


def find_materials(
    libraries: Iterable[str],
    used: Set[str],
    named_by: str,
    files: Mapping[str, bytes],
    *,
    allow_untextured: bool,
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
    files : Mapping[str, bytes]
        The upload.
    allow_untextured : bool
        Go on without files that were not sent.

    Returns
    -------
    materials : dict[str, Material]
    warnings : list[str]

    Raises
    ------
    MeshError
        MISSING_TEXTURE, UNSAFE_REFERENCE, and those of `read_mtl`.
    """
    materials: dict[str, Material] = {}
    missing: list[str] = []
    for library in dict.fromkeys(libraries):
        for reference in library_names(library, named_by, files):
            found = _find(reference, named_by, files, allow_untextured)
            if found is None:
                missing.append(reference)
            else:
                materials = {**read_mtl(files[found], found), **materials}
    undefined = used - materials.keys()
    if undefined and missing and not allow_untextured:
        raise MeshError(
            Code.MISSING_TEXTURE,
            f"“{named_by}” names the material file “{missing[0]}”, which was not sent; "
            "send it with the mesh, or allow the mesh without its texture.",
        )
    return materials, _warnings(missing, undefined - {""})


def _warnings(missing: list[str], undefined: Set[str]) -> list[str]:
    warnings = [f"the material file “{reference}” was not sent" for reference in missing]
    if undefined:
        shown = ", ".join(f"“{name}”" for name in sorted(undefined)[:3])
        warnings.append(f"{len(undefined)} materials are not defined, among them {shown}")
    return warnings


def library_names(rest: str, named_by: str, files: Mapping[str, bytes]) -> list[str]:
    """Return the file names after mtllib: one that may hold blanks, or several.

    Blanks within a name may be written with a backslash before them.
    """
    whole = rest.replace("\\ ", " ").strip().strip('"')
    if not whole or _is_sent(whole, named_by, files):
        return [whole] if whole else []
    return re.split(r"(?<=\.mtl)\s+", whole, flags=re.IGNORECASE)


def _is_sent(reference: str, named_by: str, files: Mapping[str, bytes]) -> bool:
    try:
        return find_file(files, reference, named_by) is not None
    except MeshError:
        return False


def _find(reference: str, named_by: str, files: Mapping[str, bytes], allow_untextured: bool) -> str | None:
    try:
        return find_file(files, reference, named_by)
    except MeshError:
        if allow_untextured:
            return None
        raise
