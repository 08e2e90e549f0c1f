"""Names inside files, matched to the files of the upload and never to anything else."""

import posixpath
import re
import unicodedata
from collections import defaultdict
from collections.abc import Callable, Mapping

from worker.errors import Code, MeshError
from worker.reading.showing import shown

_DRIVE = re.compile(r"[A-Za-z]:")


def normalise(path: str) -> str | None:
    """Return a relative path without ``.`` and ``..``, or None where it leaves the upload.

    Backslashes separate folders too, as programs on Windows write them.
    """
    slashed = path.replace("\\", "/")
    if not slashed or _is_absolute(slashed) or "\0" in slashed:
        return None
    normal = posixpath.normpath(slashed)
    return None if normal in {".", ".."} or normal.startswith("../") or _is_absolute(normal) else normal


def _is_absolute(slashed: str) -> bool:
    return slashed.startswith("/") or _DRIVE.match(slashed) is not None


class SentFiles:
    """The files of one upload, found by the names that other files of it use.

    Parameters
    ----------
    files : Mapping[str, bytes]
        Contents by normalised path.
    """

    def __init__(self, files: Mapping[str, bytes]) -> None:
        self._files = files
        self._by_path = _grouped(files, _folded)
        self._by_base = _grouped(files, lambda name: _folded(posixpath.basename(name)))

    def __getitem__(self, name: str) -> bytes:
        return self._files[name]

    def find(self, reference: str, named_by: str) -> str | None:
        """Find the file that a name inside another file means.

        First the path relative to the naming file, then the same in any letter case, then the only
        file with that base name.

        Parameters
        ----------
        reference : str
            The name as written.
        named_by : str
            Path of the file that holds the name.

        Returns
        -------
        str | None
            A path of the upload, or None where it was not sent or several could be meant.

        Raises
        ------
        MeshError
            UNSAFE_REFERENCE where the name points outside the upload and no file sent has its base name.
        """
        slashed = reference.strip().replace("\\", "/")
        joined = slashed if _is_absolute(slashed) else posixpath.join(posixpath.dirname(named_by), slashed)
        path = normalise(joined)
        if path in self._files:
            return path
        same_path = self._by_path.get(_folded(path), []) if path else []
        found = same_path or self._by_base.get(_folded(posixpath.basename(slashed)), [])
        if path is None and slashed and not found:
            raise MeshError(
                Code.UNSAFE_REFERENCE,
                f"{shown(named_by)} names {shown(reference)}, which lies outside of what was sent; "
                "send that file too, beside the mesh.",
            )
        return found[0] if len(found) == 1 else None


def _grouped(names: Mapping[str, bytes], key: Callable[[str], str]) -> dict[str, list[str]]:
    groups = defaultdict(list)
    for name in names:
        groups[key(name)].append(name)
    return dict(groups)


def _folded(name: str) -> str:
    """Return a name for comparing: any letter case, accents composed or not."""
    return unicodedata.normalize("NFC", name).casefold()
