"""Renewing: how a library is described anew by a version of Faience with other parameters.

The first worker of that version begins it (see `index.renewals`). Uploads go first; where none waits, a few
ready shapes are queued. All answer with their earlier descriptions until the last has an outcome, then with
the new ones, in the words that ship with this version: those that a library had learnt belong to its earlier
descriptions, and are learnt anew when its owner asks. What came meanwhile is described by this version alone:
it is compared with what is described anew already, and the answer says how much that is. A shape that
cannot be described anew is `failed` afterwards: one that no search can find must not look like one that is.
"""

import logging

from index.errors import DescriptionsChanging, NewerDescriptions
from index.renewals import Outdated
from index.vocabulary import Vocabulary, default_vocabulary
from service.library import Library
from service.storage import MADE
from service.vocabularies import NoVocabulary, own_vocabulary

BATCH = 100  # shapes that are queued, or tidied up, at once
log = logging.getLogger(__name__)


class Renewing:
    """One worker's part in it."""

    def __init__(self, library: Library) -> None:
        self._library = library
        self._told = ""  # why this worker waits

    def may_describe(self) -> bool:
        """Return whether this version's descriptions are of use; the first newer one sees to it."""
        try:
            own_vocabulary(self._library)
        except NoVocabulary:  # it may come while jobs run
            return True
        except NewerDescriptions as error:
            return self._wait(str(error))
        except DescriptionsChanging:
            return self._begin()
        return True

    def go_on(self) -> bool:
        """Do a piece of it, now that no job waits; return whether jobs were queued."""
        library = self._library
        upcoming = library.catalogue.state().next_vocabulary_id
        if upcoming is None:
            self._tidy()
            return False
        if own_vocabulary(library).id != upcoming:  # another version sees to it
            return False
        if library.catalogue.queue_renewals(BATCH):
            self._tell()
            return True
        if library.catalogue.finish_renewal():
            log.info("all shapes are described anew; searches answer from the new descriptions")
        return False

    def _begin(self) -> bool:
        vocabulary = _fitting_vocabulary(self._library)
        if vocabulary is None:
            fingerprint = self._library.parameters.fingerprint()
            return self._wait(f"no vocabulary for descriptions {fingerprint} ships with this version")
        self._library.catalogue.begin_renewal(vocabulary)
        log.info("shapes are described anew for this version; searches answer from the earlier descriptions")
        log.info("words that were learnt for this library are not taken over: `faience learn-vocabulary`")
        return True

    def _wait(self, reason: str) -> bool:
        if reason != self._told:
            log.error("this worker takes no jobs: %s", reason)
        self._told = reason
        return False

    def _tell(self) -> None:
        progress = self._library.catalogue.renewal()
        if progress is not None:
            log.info(
                "%d of %d shapes are described anew, %d cannot be",
                *(progress.done, progress.total, progress.failed),
            )

    def _tidy(self) -> None:
        outdated = self._library.catalogue.outdated(BATCH)
        for shape in outdated:
            _delete_earlier_files(self._library, shape)
        if outdated:
            self._library.catalogue.forget_earlier([shape.id for shape in outdated])


def _fitting_vocabulary(library: Library) -> Vocabulary | None:
    fingerprint = library.parameters.fingerprint()
    for vocabulary in (library.given, default_vocabulary()):
        if vocabulary is not None and vocabulary.fingerprint == fingerprint:
            return vocabulary
    return None


def _delete_earlier_files(library: Library, shape: Outdated) -> None:
    """Delete what was made of a shape and lies in no folder that is needed."""
    for key in list(library.files.keys(f"shapes/{shape.id}")):
        _, _, *folders, name = key.split("/")
        if name in MADE and ("/".join(folders) or None) not in shape.folders:
            library.files.delete(key)
