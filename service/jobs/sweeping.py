"""Files that a crash left without an owner are deleted."""

import time

from service.library import Library

HOUR = 3600.0  # seconds


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
    needed = library.catalogue.file_keys()
    newest = time.time() - older_than  # moment
    for key in [*library.files.keys("uploads"), *library.files.keys("shapes")]:
        if key not in needed and not _belongs(library, key) and _changed(library, key) <= newest:
            library.files.delete(key)
            swept += 1
    return swept


def _belongs(library: Library, key: str) -> bool:
    kind, owner = key.split("/")[:2]
    return kind == "shapes" and owner in library.catalogue.get_many([owner])


def _changed(library: Library, key: str) -> float:
    try:
        return library.files.path(key).stat().st_mtime
    except FileNotFoundError:  # removed beside us
        return time.time()
