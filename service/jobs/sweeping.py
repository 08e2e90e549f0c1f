"""Files that a crash left without an owner are deleted."""

import time

from service.library import Library
from service.remembering import LIFETIME, forget_old

HOUR = 3600.0  # seconds
BATCH = 500  # shapes in one question to the catalogue


def sweep(library: Library, older_than: float = HOUR) -> int:
    """Delete files that no shape needs; return how many.

    Such files remain when a process is killed between storing an upload and its row, or between
    removing a row and its files.

    Parameters
    ----------
    older_than : float
        Age in seconds; younger ones may belong to an upload that is under way.
    """
    swept = library.files.sweep(older_than)
    swept += forget_old(library.files, max(older_than, LIFETIME.total_seconds()))
    newest = time.time() - older_than  # moment
    for key in _unneeded(library):
        if library.files.changed(key) <= newest:
            library.files.delete(key)
            swept += 1
    return swept


def _unneeded(library: Library) -> list[str]:
    """Return the keys of files that belong to no shape."""
    needed = library.catalogue.file_keys()
    keys = [*library.files.keys("uploads"), *library.files.keys("shapes")]
    known = _known(library, {_owner(key) for key in keys if key.startswith("shapes/")})
    return [key for key in keys if key not in needed and _owner(key) not in known]


def _known(library: Library, owners: set[str]) -> set[str]:
    """Return those of the ids that are shapes."""
    listed, known = sorted(owners), set[str]()
    for start in range(0, len(listed), BATCH):
        known |= library.catalogue.get_many(listed[start : start + BATCH]).keys()
    return known


def _owner(key: str) -> str:
    return key.split("/")[1]
