"""Names inside files, matched to the files of the upload and never to anything else."""

import posixpath
import re
import unicodedata
from collections.abc import Iterable

from worker.errors import Code, MeshError

_DRIVE = re.compile(r"^[A-Za-z]:")


def normalise(path: str) -> str | None:
    """Return a relative path without ``.`` and ``..``, or None where it leaves the upload.

    Backslashes separate folders too, as programs on Windows write them.
    """
    slashed = path.strip().replace("\\", "/")
    if not slashed or slashed.startswith("/") or _DRIVE.match(slashed) or "\0" in slashed:
        return None
    normal = posixpath.normpath(slashed)
    return None if normal == ".." or normal.startswith("../") else normal


def find_file(names: Iterable[str], reference: str, named_by: str) -> str | None:
    """Find the file of the upload that a name inside another file means.

    First the path relative to the naming file, then the same in any letter case, then the only
    file with that base name.

    Parameters
    ----------
    names : Iterable[str]
        Normalised paths of the upload.
    reference : str
        The name as written.
    named_by : str
        Path of the file that holds the name.

    Returns
    -------
    str | None
        One of `names`, or None where it was not sent.

    Raises
    ------
    MeshError
        UNSAFE_REFERENCE where the name points outside the upload and no file sent has its base name.
    """
    slashed = reference.strip().replace("\\", "/")
    absolute = slashed.startswith("/") or _DRIVE.match(slashed) is not None
    path = None if absolute else normalise(posixpath.join(posixpath.dirname(named_by), slashed))
    listed = list(names)
    if path in listed:
        return path
    wanted = _folded(path) if path is not None else None
    same = [name for name in listed if _folded(name) == wanted]
    base = _folded(posixpath.basename(slashed))
    found = same or [name for name in listed if _folded(posixpath.basename(name)) == base]
    if len(found) == 1:
        return found[0]
    if path is None and not found:
        raise MeshError(
            Code.UNSAFE_REFERENCE,
            f"“{named_by}” names “{reference}”, which lies outside of what was sent; "
            "send that file too, beside the mesh.",
        )
    return None


def _folded(name: str) -> str:
    """Return a name for comparing: any letter case, accents composed or not."""
    return unicodedata.normalize("NFC", name).casefold()
