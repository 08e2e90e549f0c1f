"""The parts without which a library cannot be served: a list that each further part adds itself to."""

import os

from service.key_ring import KeyRing
from service.library import Library
from service.watching.first_load import FirstLoad
from service.watching.readiness import Check, NotWell


def checks_of(library: Library, keys: KeyRing, load: FirstLoad) -> list[Check]:
    """Return what must be well before requests are sent here."""

    def catalogue() -> None:
        library.catalogue.revision()

    def files() -> None:
        folder = library.settings.data_dir
        if not os.access(folder, os.R_OK | os.W_OK | os.X_OK):
            raise NotWell("cannot be read or written: look at the data folder and its mount")

    def known_keys() -> None:
        if not keys.readable:
            raise NotWell("could not be read for too long")

    def index() -> None:
        if not load.done:
            raise NotWell("is being loaded")

    return [
        Check(name="catalogue", run=catalogue),
        Check(name="files", run=files),
        Check(name="keys", run=known_keys),
        Check(name="index", run=index),
    ]
