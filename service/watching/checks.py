"""The parts without which a library cannot be served: a list that each further part adds itself to."""

import os
from functools import partial

from index.errors import NewerDescriptions, StorageUnreachable
from service.key_ring import KeyRing
from service.library import Library
from service.vocabularies import check_not_behind
from service.watching.first_load import FirstLoad
from service.watching.readiness import Check, NotWell


def checks_of(library: Library, keys: KeyRing, load: FirstLoad) -> list[Check]:
    """Return what must be well before requests are sent here."""
    return [
        Check(name="catalogue", run=partial(_catalogue, library)),
        Check(name="files", run=partial(_files, library)),
        Check(name="descriptions", run=partial(_descriptions, library)),
        Check(name="keys", run=partial(_keys, keys)),
        Check(name="index", run=partial(_index, load)),
    ]


def _catalogue(library: Library) -> None:
    library.catalogue.revision()


def _files(library: Library) -> None:
    if not os.access(library.settings.data_dir, os.R_OK | os.W_OK | os.X_OK):
        raise NotWell("cannot be read or written: look at the data folder and its mount")
    try:
        library.files.check()
    except StorageUnreachable as error:
        raise NotWell(f"cannot be reached: {error}") from error


def _descriptions(library: Library) -> None:
    active = library.catalogue.state().vocabulary_id
    try:
        if active is not None:
            check_not_behind(library, active)
    except NewerDescriptions as error:
        raise NotWell(f"are newer than this process: {error}") from error


def _keys(keys: KeyRing) -> None:
    if not keys.readable:
        raise NotWell("could not be read for too long")


def _index(load: FirstLoad) -> None:
    if not load.done:
        raise NotWell("is being loaded")
